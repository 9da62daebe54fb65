// The stretch of time that the timeline shows: by wheel, two fingers or keys it is narrowed, and moves with the time.

const SHORTEST_S = 0.5;
const LIVE_S = 60; // a live page shows the last minute

class Stretch {
  constructor(run, player) {
    this.run = run;
    this.player = player;
    this.narrowed = null; // [from, to], or all
    this.at = -Infinity; // the moment that was last shown
    this.fingers = new Map(); // those that are down: x by id
    document.addEventListener("keydown", (event) => this.key(event));
  }

  /** From and to, s. */
  view() {
    if (this.narrowed) return this.narrowed;
    const from = this.player.live ? Math.max(this.run.start, this.run.end - LIVE_S) : this.run.start;
    return [from, Math.max(this.run.end, from + 1)];
  }

  /** Move a narrowed stretch along where the shown moment leaves it; one that was narrowed elsewhere stays. */
  follow(at) {
    const [from, to] = this.view();
    const inside = (moment) => from <= moment && moment <= to;
    if (this.narrowed && inside(this.at) && !inside(at)) {
      const start = Math.min(this.run.end - (to - from), Math.max(this.run.start, at - 0.1 * (to - from)));
      this.narrowed = [start, start + to - from];
    }
    this.at = at;
  }

  showAll() {
    this.narrowed = null;
    this.player.refresh();
  }

  /** Widen or narrow the shown stretch about a moment. */
  zoom(about, factor) {
    const [from, to] = this.view();
    const next = [about + (from - about) * factor, about + (to - about) * factor];
    const whole = next[0] <= this.run.start && next[1] >= this.run.end;
    this.narrowed = whole
      ? null
      : [Math.max(this.run.start, next[0]), Math.min(this.run.end, Math.max(next[1], next[0] + SHORTEST_S))];
    this.player.refresh();
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
    if (event.key === "z") this.zoom(this.player.at, 0.5);
    if (event.key === "Z") this.zoom(this.player.at, 2);
    if (event.key === "0") this.showAll();
  }

  /** Listen to wheel and fingers over an element; `at` gives the moment below an event. */
  listen(element, at) {
    element.addEventListener("dblclick", () => this.showAll());
    // without a dblclick: a live page draws anew between a press and the next
    element.addEventListener("mousedown", ({ detail }) => detail === 2 && this.showAll());
    element.addEventListener(
      "wheel",
      (event) => {
        if (!event.ctrlKey && !event.shiftKey) return; // plain scrolling stays the page's
        event.preventDefault();
        this.zoom(at(event), event.deltaY + event.deltaX > 0 ? 1.25 : 0.8);
      },
      { passive: false },
    );
    this.pinch(element, at);
  }

  /** Two fingers: as far as they go apart, what is between them grows. */
  pinch(element, at) {
    const xs = () => [...this.fingers.values()];
    element.addEventListener("pointerdown", (event) => {
      if (event.isPrimary) this.fingers.clear();
      this.fingers.set(event.pointerId, event.clientX);
    });
    element.addEventListener("pointermove", (event) => {
      if (!this.fingers.has(event.pointerId)) return;
      const before = apart(xs());
      this.fingers.set(event.pointerId, event.clientX);
      if (this.isPinched()) this.zoom(at({ clientX: (xs()[0] + xs()[1]) / 2 }), before / apart(xs()));
    });
    for (const kind of ["pointerup", "pointercancel"]) {
      addEventListener(kind, (event) => this.fingers.delete(event.pointerId));
    }
  }

  isPinched() {
    return this.fingers.size === 2;
  }
}

/** How far fingers are apart, px; those side by side would stretch without limit. */
function apart([a, b]) {
  return Math.max(20, Math.abs(a - b));
}
