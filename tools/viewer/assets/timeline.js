// Everything over one axis of time: actions, events, speed, tick timing, granted checks; drag to move.

const MARGINS = { left: 80, right: 54 }; // of the lanes, for words on both sides

class Timeline {
  constructor(run, target, player) {
    this.run = run;
    this.panel = target;
    this.player = player;
    this.stretch = new Stretch(run, player);
    this.drawn = "";
    this.listen(this.panel.body);
  }

  /** From and to of what is shown, s. */
  view() {
    return this.stretch.view();
  }

  show(at) {
    this.stretch.follow(at);
    const view = this.view();
    this.width = this.panel.body.clientWidth || this.width || 1240; // a folded panel has none
    const key = `${this.run.version} ${view} ${this.width}`;
    if (key !== this.drawn) {
      this.drawn = key;
      this.lay(view);
    }
    const px = this.x(Math.min(view[1], Math.max(view[0], at)));
    this.hand.style.left = `${(100 * px) / this.width}%`;
  }

  lay(view) {
    const [low, high] = [MARGINS.left, this.width - MARGINS.right];
    const x = scale(view[0], view[1], low, high);
    Object.assign(x, { low, high, shows: (at) => at >= view[0] && at <= view[1] });
    this.x = x;
    let top = 4;
    const parts = [];
    for (const lane of this.lanes()) {
      parts.push(svg("text", { class: "strong", x: 0, y: top + (lane.label ?? 12), text: lane.name }));
      parts.push(svg("g", { "data-lane": lane.name }, ...lane.draw(x, top)));
      top += lane.height + 8;
    }
    const axis = ticks(view[0], view[1], Math.min(12, (high - low) / 60)).flatMap((t) => [
      svg("line", { class: "grid", x1: x(t), x2: x(t), y1: 0, y2: top }),
      svg("text", { x: x(t), y: top + 12, "text-anchor": "middle", text: `${t} s` }),
    ]);
    this.hand = html("div", { class: "hand" }); // above the drawing, which need not be painted again when it moves
    const hit = svg("rect", { class: "hit", x: x.low, y: 0, width: x.high - x.low, height: top });
    this.drawing = svg(
      "svg",
      { viewBox: `0 0 ${this.width} ${top + 16}`, role: "img", "aria-label": "the run over time" },
      svg("g", {}, ...axis),
      hit,
      ...parts,
    );
    this.panel.body.replaceChildren(html("div", { class: "layers" }, this.drawing, this.hand));
    this.panel.note.replaceChildren(`${this.summary()} `, this.outcomes());
  }

  lanes() {
    const run = this.run;
    const times = run.about().times ?? { period: 100, budget: 60, end: 80 };
    const lanes = [
      { name: "action", height: 38, label: 26, draw: (x, top) => actionLane(run, x, top) },
      { name: "event", height: 16, draw: (x, top) => eventLane(run, x, top) },
    ];
    const source = run.source();
    // A pen of an arm has neither a heading nor a speed: zeros would be wrong.
    if (source && run.all(source).some((p) => p.phi !== null || p.v)) {
      const points = run.all(source).map((p) => [p.at, p.v]);
      lanes.push({
        name: "speed",
        height: 50,
        draw: (x, top) =>
          curveLane(
            x,
            top,
            50,
            [{ points, kind: "trace c0" }, ...this.commanded()],
            extent([0, ...points.map((p) => p[1])]),
            "m/s",
          ),
      });
    }
    if (run.all("tick").length) {
      lanes.push({ name: "tick ms", height: 74, draw: (x, top) => tickLane(run, x, top, 74, times) });
      const checks = run.all("tick").map((row) => [row.at, row.checks]);
      lanes.push({
        name: "checks",
        height: 42,
        draw: (x, top) =>
          curveLane(
            x,
            top,
            42,
            [{ points: checks, kind: "trace c2", whole: true }],
            [
              0,
              Math.max(
                1,
                extent(
                  checks.map((c) => c[1]),
                  0.02,
                )[1],
              ),
            ],
            "granted",
          ),
      });
    }
    return lanes;
  }

  commanded() {
    const rows = this.run.all("series cmd_vel");
    return rows.length ? [{ points: rows.map((row) => [row.at, row.v]), kind: "ghost" }] : [];
  }

  /** A legend of the colours of actions that did not end as they should, as far as there are any. */
  outcomes() {
    const found = new Set(this.run.actions().map((action) => action.ended?.outcome));
    return legend(["failed", "aborted"].filter((each) => found.has(each)).map((each) => [each, each]));
  }

  summary() {
    const rows = this.run.all("tick");
    if (!rows.length) return "";
    const [work, late] = [rows.map((row) => row.work), rows.map((row) => row.late)];
    const missed = rows.reduce((sum, row) => sum + row.skipped, 0);
    const ms = (value) => `${value.toFixed(value < 10 ? 1 : 0)} ms`;
    return `${rows.length} ticks · work p50 ${ms(quantile(work, 0.5))}, p99 ${ms(quantile(work, 0.99))} · late p99 ${ms(quantile(late, 0.99))}, max ${ms(quantile(late, 1))} · ${missed} missed`;
  }

  /** Listen on the panel, which stays: a live page draws anew between a press and the next. */
  listen(body) {
    const at = (event) => {
      const box = this.drawing.getBoundingClientRect();
      return this.x.invert(((event.clientX - box.left) / box.width) * this.width);
    };
    body.addEventListener("pointerdown", (event) => {
      this.dragging = event.isPrimary;
      if (this.dragging) this.player.go(at(event));
    });
    body.addEventListener("pointermove", (event) => {
      if (this.dragging && event.buttons && !this.stretch.isPinched()) this.player.go(at(event));
    });
    this.stretch.listen(body, at);
  }
}
