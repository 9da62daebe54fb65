// One angle of the belief over the other, as the paper's Figure 13 draws letters: the way so far, and the waypoints.

const JOINTS = { width: 760, height: 430, left: 46, right: 14, top: 12, bottom: 28 };

class JointPlane {
  constructor(run, waypoints, [from, to]) {
    const names = run.about().beliefNames;
    const chosen = names
      .map((name, i) => [name, i])
      .filter(([name]) => name.endsWith("(rad)"))
      .slice(0, 2);
    this.places = chosen.map(([, i]) => i);
    const rows = run.all("belief").filter((row) => row.values.length > Math.max(...this.places));
    this.actions = run.actions().filter((action) => action.begin >= from && action.begin < to);
    const begin = this.actions[0].begin - 0.05; // before it the belief may be a guess
    this.points = rows
      .filter((row) => row.at >= begin && row.at < to)
      .map((row) => ({ at: row.at, x: row.values[this.places[0]], y: row.values[this.places[1]] }));
    this.lay(
      chosen.map(([name]) => name),
      waypoints,
    );
  }

  lay([first, second], waypoints) {
    const { width, height, left, right, top, bottom } = JOINTS;
    const [x0, x1] = extent(
      [...this.points, ...waypoints].map((p) => p.x),
      0.12,
    );
    const [y0, y1] = extent(
      [...this.points, ...waypoints].map((p) => p.y),
      0.12,
    );
    const perUnit = Math.min((width - left - right) / (x1 - x0), (height - top - bottom) / (y1 - y0)); // the same both ways
    this.x = (v) => (width + left - right) / 2 + (v - (x0 + x1) / 2) * perUnit;
    this.y = (v) => (height + top - bottom) / 2 - (v - (y0 + y1) / 2) * perUnit;
    const way = (points) => through(points.map((p) => [this.x(p.x), this.y(p.y)]));
    this.stretches = this.actions.map((action, i, all) => {
      const end = all[i + 1]?.begin ?? action.until; // between two actions the arm moves on
      return { action, points: this.points.filter((p) => p.at >= action.begin - 0.05 && p.at <= end + 0.05) };
    });
    this.moving = svg("g");
    this.way = way;
    this.element = svg(
      "svg",
      { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `${second} over ${first}` },
      ...ticks(x0, x1, 7).flatMap((v) => [
        svg("line", { class: "grid", x1: this.x(v), x2: this.x(v), y1: top, y2: height - bottom }),
        svg("text", { x: this.x(v), y: height - bottom + 13, "text-anchor": "middle", text: String(v) }),
      ]),
      ...ticks(y0, y1, 5).flatMap((v) => [
        svg("line", { class: "grid", x1: left, x2: width - right, y1: this.y(v), y2: this.y(v) }),
        svg("text", { x: left - 6, y: this.y(v) + 4, "text-anchor": "end", text: String(v) }),
      ]),
      svg("text", { class: "strong", x: width - right, y: height - 2, "text-anchor": "end", text: first }),
      svg("text", { class: "strong", x: left + 4, y: top + 6, text: second }),
      ...this.stretches.map((s) =>
        svg("path", { class: `trace ${colour(s.action.index)}`, style: "opacity:.25", d: way(s.points) }),
      ),
      this.moving,
      ...waypoints.flatMap((p) => [
        svg("circle", { class: "dot", cx: this.x(p.x), cy: this.y(p.y), r: 4 }),
        svg("text", { class: "ink halo", x: this.x(p.x) + 8, y: this.y(p.y) - 6, text: p.place }),
      ]),
    );
  }

  move(at) {
    const now = this.points.filter((p) => p.at <= at).pop();
    const parts = this.stretches.map((s) =>
      svg("path", {
        class: `trace ${colour(s.action.index)}`,
        style: "stroke-width:2.6",
        d: this.way(s.points.filter((p) => p.at <= at)),
      }),
    );
    if (now) parts.push(svg("circle", { class: "object", cx: this.x(now.x), cy: this.y(now.y), r: 5 }));
    this.moving.replaceChildren(...parts);
  }
}
