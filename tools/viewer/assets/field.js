// The field from above like the paper's Figure 1: lines across the heading, whose length is the speed.

const LINE_S = 0.32; // metres of line for each metre a second: 0.9 m/s draws 0.29 m
const ROBOT = [0.41, 0.32]; // length and breadth of the drawn robot, metres
const OBJECT_M = 0.11; // radius of a drawn object

class Field {
  constructor(run, target) {
    this.run = run;
    this.panel = target;
    this.drawn = -1;
  }

  /** Show a time. Static parts are redrawn only after new events or for another episode. */
  show(at) {
    if (this.drawn !== this.run.version) this.lay();
    const [from, to] = this.run.episode(at);
    if (from !== this.from) this.layEpisode(from, to);
    this.colourStrokes(at);
    this.moving.replaceChildren(...this.movingParts(at));
  }

  /** The frame of the run: two layers, so that moving parts do not repaint static ones. */
  lay() {
    this.drawn = this.run.version;
    this.from = null;
    const { map, width, height } = this.frame();
    this.map = map;
    const box = `0 0 ${width} ${height}`;
    this.still = svg("g");
    this.moving = svg("g");
    const below = svg(
      "svg",
      { viewBox: box, role: "img", "aria-label": "the robot's path seen from above" },
      svg("g", {}, ...this.gridLines(width, height)),
      this.still,
    );
    const above = svg("svg", { viewBox: box, class: "above", "aria-hidden": "true" }, this.moving);
    this.panel.body.replaceChildren(html("div", { class: "layers" }, below, above));
    this.panel.title.textContent = "Field";
    this.panel.note.replaceChildren(this.legend());
  }

  /** Path of one episode: a drawing for each action, pale in the future. */
  layEpisode(from, to) {
    this.from = from;
    this.path = this.run.between(this.run.source(), from, to);
    this.segments = segmentsOf(this.path);
    for (const segment of this.segments) segment.element = svg("path", { d: this.strokes(segment.points) });
    const ghost =
      this.run.source() === "truth" ? this.run.between("believed", from, to).map((p) => this.map(p.x, p.y)) : [];
    this.still.replaceChildren(
      ...this.segments.map((s) => s.element),
      svg("path", { class: "ghost", d: through(ghost) }),
      ...this.objectPaths(),
    );
  }

  /** Path and start of every object. */
  objectPaths() {
    const names = new Set(this.path.flatMap((p) => Object.keys(p.objects ?? {})));
    return [...names].flatMap((name) => {
      const places = this.path.map((p) => (p.objects?.[name] ? this.map(...p.objects[name]) : null));
      const first = places.find((place) => place !== null);
      return [
        svg("path", { class: "objectpath", d: through(places) }),
        svg("circle", { class: "objectstart", cx: first[0], cy: first[1], r: OBJECT_M * this.map.perMetre }),
      ];
    });
  }

  colourStrokes(at) {
    for (const segment of this.segments) {
      const ahead = segment.points[segment.points.length - 1].at > at;
      const kind = `strokes ${ahead ? "ahead " : ""}${colour(segment.index)}`;
      if (segment.element.getAttribute("class") !== kind) segment.element.setAttribute("class", kind);
    }
  }

  /** Map from metres to pixels: all drawn places, with a margin, y upwards. */
  frame() {
    const path = this.run.all(this.run.source());
    const places = this.run.all("subgoals").flatMap(placesOf);
    const objects = path.flatMap((p) => Object.values(p.objects ?? {}));
    const xs = [...path.map((p) => p.x), ...places.map((p) => p.x), ...objects.map((o) => o[0])];
    const ys = [...path.map((p) => p.y), ...places.map((p) => p.y), ...objects.map((o) => o[1])];
    let [left, right] = extent(xs, 0);
    let [bottom, top] = extent(ys, 0);
    [left, right, bottom, top] = [left - 0.55, right + 0.55, bottom - 0.55, top + 0.55];
    const wanted = 1.06; // the frame's shape, so that the page does not jump
    const lacking = (right - left) / (top - bottom) - wanted;
    if (lacking < 0) {
      const more = ((top - bottom) * wanted - (right - left)) / 2;
      left -= more;
      right += more;
    } else {
      const more = ((right - left) / wanted - (top - bottom)) / 2;
      bottom -= more;
      top += more;
    }
    const width = 760;
    const perMetre = width / (right - left);
    const height = (top - bottom) * perMetre;
    const map = (x, y) => [(x - left) * perMetre, (top - y) * perMetre];
    map.perMetre = perMetre;
    map.box = [left, right, bottom, top];
    return { map, width, height };
  }

  gridLines(width, height) {
    const [left, right, bottom, top] = this.map.box;
    const vertical = ticks(left, right, 8).flatMap((x) => {
      const [px] = this.map(x, 0);
      return [
        svg("line", { class: "grid", x1: px, x2: px, y1: 0, y2: height }),
        svg("text", { x: px + 3, y: height - 4, text: String(x) }),
      ];
    });
    const horizontal = ticks(bottom, top, 6).flatMap((y) => {
      const [, py] = this.map(0, y);
      return [
        svg("line", { class: "grid", x1: 0, x2: width, y1: py, y2: py }),
        svg("text", { x: 3, y: py - 3, text: y === 0 ? "0" : String(y) }),
      ];
    });
    return [...vertical, ...horizontal, svg("text", { x: width - 4, y: 12, "text-anchor": "end", text: "x, y in m" })];
  }

  movingParts(at) {
    const parts = this.segments
      .filter((s) => s.points[0].at <= at && s.points[s.points.length - 1].at > at)
      .map((s) =>
        svg("path", { class: `strokes ${colour(s.index)}`, d: this.strokes(s.points.filter((p) => p.at <= at)) }),
      );
    const robot = this.run.last(this.run.source(), at);
    if (robot) parts.push(...this.robot(robot));
    for (const place of Object.values(robot?.objects ?? {})) {
      const [x, y] = this.map(...place);
      parts.push(svg("circle", { class: "object", cx: x, cy: y, r: OBJECT_M * this.map.perMetre }));
    }
    return [...parts, ...new SubgoalMarks(this.run, this.map).at(at)];
  }

  robot(pose) {
    const [length, breadth] = ROBOT;
    const corner = (ahead, left) =>
      this.map(
        pose.x + ahead * Math.cos(pose.phi) - left * Math.sin(pose.phi),
        pose.y + ahead * Math.sin(pose.phi) + left * Math.cos(pose.phi),
      );
    const body = [
      corner(length / 2, breadth / 2.6),
      corner(length / 4, breadth / 2),
      corner(-length / 2, breadth / 2),
      corner(-length / 2, -breadth / 2),
      corner(length / 4, -breadth / 2),
      corner(length / 2, -breadth / 2.6),
    ];
    return [
      svg("path", { class: "robot", d: `${through(body)}Z` }),
      svg("path", { class: "robot nose", d: through([corner(0, 0), corner(length / 2, 0)]) }),
    ];
  }

  strokes(points) {
    let d = "";
    for (const p of points) {
      const half = (LINE_S * Math.abs(p.v)) / 2 + 0.005;
      const [dx, dy] = [-Math.sin(p.phi) * half, Math.cos(p.phi) * half];
      d += through([this.map(p.x - dx, p.y - dy), this.map(p.x + dx, p.y + dy)]);
    }
    return d;
  }

  legend() {
    const named = new Map(this.run.actions().map((a) => [`${colour(a.index)} ${a.action}`, a]));
    const pairs = [...named.values()].slice(0, 6).map((a) => [colour(a.index), a.action]);
    return legend([...pairs, ...(this.run.source() === "truth" ? [["idle", "dotted: believed path"]] : [])]);
  }
}

/** Stretches of the path within one action: [{index, points}]. */
function segmentsOf(path) {
  const segments = [];
  for (const point of path) {
    const last = segments[segments.length - 1];
    if (last && last.index === point.index) last.points.push(point);
    else segments.push({ index: point.index, points: [point] });
  }
  return segments;
}
