// What is no longer true of the present: parts of the system that are silent, a lost bus, a viewer that hangs.

const STALLED_MS = 3000; // without a sign of life of the viewer, which sends two a second
const CHECK_MS = 500;
const LOST = "the viewer does not respond";
const REFUSED = "the viewer serves no more pages; close another one";

class Liveness {
  constructor(run, live) {
    this.run = run;
    this.live = live; // whether the page shows the present
    this.state = ""; // of the connection to the viewer: open, stalled, lost or refused
    this.heardMs = 0;
  }

  /** Call back whenever the connection may have changed. */
  watch(callback) {
    setInterval(() => {
      if (this.state === "open" && performance.now() - this.heardMs > STALLED_MS) this.become("stalled");
      callback();
    }, CHECK_MS);
  }

  /** A sign of life of the viewer. */
  heard() {
    this.heardMs = performance.now();
    if (this.state === "stalled") this.become("open"); // after a loss the viewer's reset opens it
  }

  become(state) {
    this.state = state;
    document.documentElement.dataset.connection = state;
  }

  /** Why the state shown at a time holds no longer; empty if it does. */
  words(at) {
    if (this.live && this.state === "refused") return [REFUSED];
    if (this.live && ["stalled", "lost"].includes(this.state)) return [LOST];
    const silent = this.run.silent(at).map(([part, since]) => `${part} silent for ${seconds(since, 1)}`);
    return this.live && !this.run.bus ? ["the viewer has lost the bus", ...silent] : silent;
  }
}
