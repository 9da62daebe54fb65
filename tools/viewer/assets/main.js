// Assembles the panels, feeds them from embedded events or the server, and reads #t= of the address.

const given = JSON.parse(document.getElementById("data").textContent);
const AGAIN_MS = 2000; // after the viewer has refused a page
const root = document.documentElement;
const run = new Run();
given.rows.forEach((row) => run.add(row));
given.samples.forEach((block) => run.addSamples(block));

const liveness = new Liveness(run, given.live);
const player = new Player(run, given.live);
const timeline = new Timeline(run, panel("timeline"), player);
const views = [
  new Heading(run, given.title, liveness),
  new ChoicePanel(run, panel("choice"), player),
  new PlanGraph(run, panel("plan")),
  timeline,
];
const stop = given.live && given.stop ? new StopButton(run, () => given.stop) : null;
let scene = null;

/** The scene of a robot with a heading on the plane, the scene and small multiples of others. */
function sceneNow() {
  const source = run.source();
  const wanted = !source ? Series : run.all(source).some((p) => p.phi !== null) ? Field : FieldAndSeries;
  if (!(scene instanceof wanted)) scene = new wanted(run, panel("scene"));
  return scene;
}

player.watch((at) => {
  for (const view of views) view.show(at);
  stop?.show();
  sceneNow().show(at, timeline.view());
  root.dataset.at = at.toFixed(3);
  root.dataset.rows = String(run.version);
  root.dataset.kept = String(run.kept());
});

/** Restart after a reconnection, perhaps to another server: it sends all events again, and its stop button's token. */
function restart(event) {
  given.stop = JSON.parse(event.data).stop;
  Object.assign(run, new Run(), { version: run.version + 1 }); // the version continues: it marks what is drawn
  liveness.become("open"); // not earlier: without the server's token the stop button waits for it
  liveness.heard();
  stop?.forget();
  player.grown();
}

/** Whether an event is a sign of life alone; it belongs to no run. */
function isBeat([, kind]) {
  return kind === "now";
}

function listen() {
  const source = new EventSource("events");
  source.addEventListener("reset", restart);
  source.addEventListener("rows", (event) => {
    liveness.heard();
    const rows = JSON.parse(event.data);
    for (const [at, , fields] of rows.filter(isBeat)) run.beat(at, fields);
    const events = rows.filter((row) => !isBeat(row));
    events.forEach((row) => run.add(row));
    run.forget();
    if (events.length) player.grown();
    else player.refresh();
  });
  source.onerror = () => {
    const refused = source.readyState === EventSource.CLOSED; // the browser tries again only after a loss
    liveness.become(refused ? "refused" : "lost");
    if (refused) setTimeout(listen, AGAIN_MS);
    player.refresh();
  };
}

if (given.framed) framed(run, player);
else player.set(addressed() ?? (given.live ? Infinity : run.end));
addEventListener("resize", () => player.refresh());
if (given.live) listen();
if (given.live) liveness.watch(() => player.refresh());
if (stop) document.getElementById("heading").append(stop.element);
root.dataset.ready = "yes";
