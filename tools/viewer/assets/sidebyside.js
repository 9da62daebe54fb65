// Several runs beside one another, in step: each is a page in a frame, and one player moves all. Time counts from the
// start of each run's first action.

class Together {
  constructor(count) {
    this.start = 0;
    this.end = 0;
    this.runs = Array(count).fill(null); // what each frame reports: {end, landmarks}
  }

  add(number, report) {
    this.runs[number] = report;
    const known = this.runs.filter(Boolean);
    this.start = Math.min(...known.map((run) => run.start));
    this.end = Math.max(...known.map((run) => run.end));
  }

  landmarks() {
    return [...new Set(this.runs.flatMap((run) => run?.landmarks ?? []))].sort((a, b) => a - b);
  }
}

const given = JSON.parse(document.getElementById("data").textContent);
const together = new Together(given.pages.length);
const player = new Player(together, false);
const frames = given.pages.map(({ title, page }) => html("iframe", { title, srcdoc: page }));
document.getElementById("frames").append(...frames);
document.documentElement.style.setProperty("--runs", frames.length);

player.watch((at) => {
  for (const frame of frames) frame.contentWindow.postMessage({ at }, "*");
  document.documentElement.dataset.at = at.toFixed(3);
});

addEventListener("message", ({ source, data }) => {
  const number = frames.findIndex((frame) => frame.contentWindow === source);
  if (number < 0) return;
  if (data.report) {
    together.add(number, data.report);
    player.set(addressed() ?? 0);
    if (together.runs.every(Boolean)) document.documentElement.dataset.ready = "yes";
  }
  if (data.height) frames[number].style.height = `${data.height}px`;
  if (data.go !== undefined) player.go(data.go);
  if (data.key) player.key({ ...data.key, target: document.body, preventDefault() {} });
});
