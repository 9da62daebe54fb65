// Assembles the panels, feeds them from embedded events or the server, and reads #t= of the address.

const given = JSON.parse(document.getElementById("data").textContent);
const root = document.documentElement;
const run = new Run();
given.rows.forEach((row) => run.add(row));
given.samples.forEach((block) => run.addSamples(block));

const player = new Player(run, given.live);
const timeline = new Timeline(run, panel("timeline"), player);
const views = [
  new Heading(run, given.title),
  new ChoicePanel(run, panel("choice")),
  new PlanGraph(run, panel("plan")),
  timeline,
];
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
  sceneNow().show(at, timeline.view());
  root.dataset.at = at.toFixed(3);
  root.dataset.rows = String(run.version);
});

/** Restart after a reconnection, perhaps to another server: it sends all events again, and its stop button's token. */
function restart(event) {
  given.stop = JSON.parse(event.data).stop;
  Object.assign(run, new Run(), { version: run.version + 1 }); // the version continues: it marks what is drawn
  root.dataset.connection = "open"; // not earlier: without the server's token the stop button waits for it
  document.title = given.title;
}

function listen() {
  const source = new EventSource("events");
  source.addEventListener("reset", restart);
  source.addEventListener("rows", (event) => {
    JSON.parse(event.data).forEach((row) => run.add(row));
    player.grown();
  });
  source.onerror = () => {
    root.dataset.connection = "lost";
    document.title = `${given.title} (connection lost)`;
  };
}

if (given.framed) framed(run, player);
else player.set(addressed() ?? (given.live ? Infinity : run.end));
addEventListener("resize", () => player.refresh());
if (given.live) listen();
if (given.live && given.stop) document.getElementById("heading").append(stopButton(() => given.stop));
root.dataset.ready = "yes";
