// Puts the panels together, feeds them from the embedded rows or the server, and keeps the address's #t= in step.

const given = JSON.parse(document.getElementById("data").textContent);
const root = document.documentElement;
const run = new Run();
given.rows.forEach((row) => run.add(row));

const player = new Player(run, given.live);
const timeline = new Timeline(run, panel("timeline"), player);
const views = [
  new Heading(run, given.title),
  new ChoicePanel(run, panel("choice")),
  new PlanGraph(run, panel("plan")),
  timeline,
];
let scene = null;

/** A field for what moves on a plane, small multiples for everything else. */
function sceneNow() {
  const wanted = run.source() ? Field : Series;
  if (!(scene instanceof wanted)) scene = new wanted(run, panel("scene"));
  return scene;
}

player.watch((at) => {
  for (const view of views) view.show(at);
  sceneNow().show(at, timeline.view());
  root.dataset.at = at.toFixed(3);
  root.dataset.rows = String(run.version);
});

/** Start over, as after a reconnection: the server tells everything again. */
function forget() {
  Object.assign(run, new Run(), { version: run.version + 1 }); // the version goes on: it tells what is drawn already
}

function listen() {
  const source = new EventSource("events");
  source.addEventListener("reset", forget);
  source.addEventListener("rows", (event) => {
    JSON.parse(event.data).forEach((row) => run.add(row));
    player.grown();
  });
  source.onopen = () => {
    root.dataset.connection = "open";
    document.title = given.title;
  };
  source.onerror = () => {
    root.dataset.connection = "lost";
    document.title = `${given.title} (connection lost)`;
  };
}

const asked = /^#t=([0-9.]+)$/.exec(location.hash);
player.set(asked ? Number(asked[1]) : given.live ? Infinity : run.end);
if (given.live) listen();
root.dataset.ready = "yes";
