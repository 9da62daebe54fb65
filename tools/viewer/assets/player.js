// The shown time: slider, play and pause, keyboard, and following a live run.

const SPEEDS = [0.25, 0.5, 1, 2, 4, 8];

/** The moment that the address names, as #t=4.2, seconds; null if it names none. */
function addressed() {
  const at = Number(/^#t=(-?[0-9.]+)$/.exec(location.hash)?.[1] ?? NaN);
  return Number.isFinite(at) ? at : null;
}

/** Whether a key presses what has the focus, and moves no time. */
function isPress({ key, target }) {
  return key === " " && ["BUTTON", "SUMMARY"].includes(target.tagName);
}

class Player {
  constructor(run, live) {
    this.run = run;
    this.live = live; // whether events may still arrive
    this.follow = live; // whether to show the newest time
    this.playing = false;
    this.at = 0;
    this.speed = 1;
    this.watchers = [];
    this.build();
    document.addEventListener("keydown", (event) => this.key(event));
  }

  build() {
    this.button = html("button", {
      type: "button",
      class: "play",
      "aria-label": "play or pause",
      onclick: () => this.toggle(),
    });
    this.slider = html("input", {
      type: "range",
      min: 0,
      max: 1,
      step: 0.01,
      value: 0,
      "aria-label": "time",
      oninput: () => this.go(Number(this.slider.value)),
    });
    this.clock = html("output");
    const choices = SPEEDS.map((speed) => html("option", { value: speed, text: `${speed}×` }));
    this.speeds = html(
      "select",
      {
        "aria-label": "speed",
        onchange: () => {
          this.speed = Number(this.speeds.value);
        },
      },
      ...choices,
    );
    this.speeds.value = "1";
    this.newest = this.live ? html("button", { type: "button", onclick: () => this.catchUp(), text: "live" }) : null;
    const keys = html("span", {
      class: "keys",
      text: "space ← → ⇧ [ ] home end + − z 0",
      title:
        "space: play or pause; arrows: 0.1 s, with shift 1 s; brackets: previous and next event; + and −: speed; z, with shift Z, or shift and wheel over the timeline: narrow and widen; 0: show all",
    });
    document
      .getElementById("player")
      .replaceChildren(...[this.button, this.slider, this.clock, this.speeds, this.newest, keys].filter(Boolean));
  }

  /** Call back with the shown time whenever it or the run changes. */
  watch(callback) {
    this.watchers.push(callback);
  }

  /** Show a time, clipped to the run; manual moves stop following. */
  go(at) {
    this.follow = false;
    this.set(at);
  }

  set(at) {
    this.at = Math.min(this.run.end, Math.max(this.run.start, at));
    this.refresh();
  }

  catchUp() {
    this.follow = true;
    this.playing = false;
    this.set(this.run.end);
  }

  /** Update after new events. */
  grown() {
    if (this.follow) this.set(this.run.end);
    else this.refresh();
  }

  refresh() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.paint();
    });
  }

  paint() {
    this.slider.max = this.run.end;
    this.slider.value = this.at;
    this.clock.textContent = `${this.at.toFixed(1)} of ${this.run.end.toFixed(1)} s`;
    this.button.textContent = this.playing || this.follow ? "❚❚" : "▶";
    this.newest?.setAttribute("aria-pressed", this.follow);
    for (const watcher of this.watchers) watcher(this.at);
  }

  toggle() {
    if (this.follow) {
      this.follow = false;
      this.refresh();
      return;
    }
    this.playing = !this.playing;
    if (this.playing && this.at >= this.run.end) this.at = this.run.start;
    if (this.playing) this.advance(performance.now());
    this.refresh();
  }

  advance(then) {
    requestAnimationFrame((now) => {
      if (!this.playing) return;
      this.set(this.at + ((now - then) / 1000) * this.speed);
      if (this.at >= this.run.end) {
        this.playing = false;
        this.follow = this.live;
      } else this.advance(now);
    });
  }

  jump(direction) {
    const marks = this.run.landmarks();
    const next =
      direction > 0 ? marks.find((m) => m > this.at + 0.005) : marks.filter((m) => m < this.at - 0.005).pop();
    this.go(next ?? (direction > 0 ? this.run.end : this.run.start));
  }

  faster(steps) {
    const place = SPEEDS.indexOf(this.speed) + steps;
    this.speed = SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, place))];
    this.speeds.value = String(this.speed);
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = event.shiftKey ? 1 : 0.1;
    const actions = {
      " ": () => this.toggle(),
      ArrowLeft: () => this.go(this.at - step),
      ArrowRight: () => this.go(this.at + step),
      Home: () => this.go(this.run.start),
      End: () => (this.live ? this.catchUp() : this.go(this.run.end)),
      "[": () => this.jump(-1),
      "]": () => this.jump(1),
      "+": () => this.faster(1),
      "-": () => this.faster(-1),
      l: () => this.live && this.catchUp(),
    };
    const action = actions[event.key];
    const pressed = isPress(event) && event.target !== this.button;
    if (!action || pressed || event.target.tagName === "SELECT") return;
    event.preventDefault();
    action();
  }
}
