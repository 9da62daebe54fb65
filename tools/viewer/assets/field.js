// The field from above in the manner of the paper's Figure 1: lines across the heading, as long as the robot is fast.

const LINE_S = 0.32; // metres of line for each metre a second: 0.9 m/s draws 0.29 m
const ROBOT = [0.41, 0.32]; // length and breadth of the drawn robot, metres
const BALL_M = 0.11;
const RING_M = [0.3, 0.62]; // where the alternatives' petals stand around a place

class Field {
  constructor(run, target) {
    this.run = run;
    this.panel = target;
    this.drawn = -1;
  }

  /** Show a moment. What stands still is drawn anew only when rows have come or another episode is shown. */
  show(at) {
    if (this.drawn !== this.run.version) this.lay();
    const [from, to] = this.run.episode(at);
    if (from !== this.from) this.layEpisode(from, to);
    this.colourStrokes(at);
    this.moving.replaceChildren(...this.movingParts(at));
  }

  /** The frame for the whole run: two drawings, so that what moves does not make the rest be painted again. */
  lay() {
    this.drawn = this.run.version;
    this.from = null;
    const { map, width, height } = this.frame();
    this.map = map;
    const box = `0 0 ${width} ${height}`;
    this.still = svg("g");
    this.moving = svg("g");
    const below = svg("svg", { viewBox: box, role: "img", "aria-label": "the robot's path seen from above" }, svg("g", {}, ...this.gridLines(width, height)), this.still);
    const above = svg("svg", { viewBox: box, class: "above", "aria-hidden": "true" }, this.moving);
    this.panel.body.replaceChildren(html("div", { class: "layers" }, below, above));
    this.panel.title.textContent = "Field";
    this.panel.note.replaceChildren(this.legend());
  }

  /** One episode's path: a drawing for each action, pale until it has happened. */
  layEpisode(from, to) {
    this.from = from;
    this.path = this.run.between(this.run.source(), from, to);
    this.segments = segmentsOf(this.path);
    for (const segment of this.segments) segment.element = svg("path", { d: this.strokes(segment.points) });
    const ghost = this.run.source() === "truth" ? this.run.between("believed", from, to).map((p) => this.map(p.x, p.y)) : [];
    this.still.replaceChildren(...this.segments.map((s) => s.element), svg("path", { class: "ghost", d: through(ghost) }), ...this.ballParts());
  }

  ballParts() {
    const balls = this.path.map((p) => (p.ball ? this.map(...p.ball) : null));
    const first = balls.find((b) => b !== null);
    if (!first) return [];
    return [svg("path", { class: "ballpath", d: through(balls) }), svg("circle", { class: "ballstart", cx: first[0], cy: first[1], r: BALL_M * this.map.perMetre })];
  }

  colourStrokes(at) {
    for (const segment of this.segments) {
      const ahead = segment.points[segment.points.length - 1].at > at;
      const kind = `strokes ${ahead ? "ahead " : ""}${colour(segment.index)}`;
      if (segment.element.getAttribute("class") !== kind) segment.element.setAttribute("class", kind);
    }
  }

  /** Pixels for metres: everything that is ever drawn, with a margin, y upwards. */
  frame() {
    const path = this.run.all(this.run.source());
    const places = this.run.all("subgoals").flatMap(placesOf);
    const balls = path.filter((p) => p.ball).map((p) => p.ball);
    const xs = [...path.map((p) => p.x), ...places.map((p) => p.x), ...balls.map((b) => b[0])];
    const ys = [...path.map((p) => p.y), ...places.map((p) => p.y), ...balls.map((b) => b[1])];
    let [left, right] = extent(xs, 0);
    let [bottom, top] = extent(ys, 0);
    [left, right, bottom, top] = [left - 0.55, right + 0.55, bottom - 0.55, top + 0.55];
    const wanted = 1.06; // the frame's shape, so that the page does not jump
    const lacking = (right - left) / (top - bottom) - wanted;
    if (lacking < 0) { const more = ((top - bottom) * wanted - (right - left)) / 2; left -= more; right += more; }
    else { const more = ((right - left) / wanted - (top - bottom)) / 2; bottom -= more; top += more; }
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
      return [svg("line", { class: "grid", x1: px, x2: px, y1: 0, y2: height }), svg("text", { x: px + 3, y: height - 4, text: String(x) })];
    });
    const horizontal = ticks(bottom, top, 6).flatMap((y) => {
      const [, py] = this.map(0, y);
      return [svg("line", { class: "grid", x1: 0, x2: width, y1: py, y2: py }), svg("text", { x: 3, y: py - 3, text: y === 0 ? "0" : String(y) })];
    });
    return [...vertical, ...horizontal, svg("text", { x: width - 4, y: 12, "text-anchor": "end", text: "x, y in m" })];
  }

  movingParts(at) {
    const parts = this.segments
      .filter((s) => s.points[0].at <= at && s.points[s.points.length - 1].at > at)
      .map((s) => svg("path", { class: `strokes ${colour(s.index)}`, d: this.strokes(s.points.filter((p) => p.at <= at)) }));
    const subgoals = this.run.last("subgoals", at);
    const why = this.run.last("why", at);
    const robot = this.run.last(this.run.source(), at);
    if (robot) parts.push(...this.robot(robot));
    if (robot?.ball) {
      const [x, y] = this.map(...robot.ball);
      parts.push(svg("circle", { class: "ball", cx: x, cy: y, r: BALL_M * this.map.perMetre }));
    }
    const places = placesOf(subgoals).filter((place) => place.goal);
    for (const place of places) parts.push(...this.place(place, at, why));
    return [...parts, ...places.map((place) => this.label(place))];
  }

  /** A subgoal: an arrow where it points; where it is free also its range, its alternatives and greedy's choice. */
  place(place, at, why) {
    const free = place.free.length > 0;
    const heading = place.free.find((p) => p.quantity === "phi");
    const parts = [];
    if (heading) {
      const said = why?.parameters.find((a) => a.place === place.label && a.quantity === "phi");
      parts.push(...(said ? this.petals(place, said) : [this.arc(place, heading)]));
      for (const phi of earlierHeadings(this.run, at, place.label)) parts.push(this.arrow(place, phi, "place free before", 0.3));
      if (said) parts.push(this.arrow(place, said.greedy, "place lone", 0.34));
    }
    const [x, y] = this.map(place.x, place.y);
    if (Number.isFinite(place.phi)) parts.push(this.arrow(place, place.phi, free ? "place free" : "place", 0.36));
    parts.push(svg("circle", { class: free ? "place free" : "place", cx: x, cy: y, r: 2.2 }));
    return parts;
  }

  label(place) {
    const [x, y] = this.map(place.x, place.y);
    return svg("text", { class: "strong halo", x: x + 9, y: y + 17, text: place.label });
  }

  arrow(place, phi, kind, length) {
    const tip = this.map(place.x + length * Math.cos(phi), place.y + length * Math.sin(phi));
    const barb = (turn) => this.map(place.x + (length - 0.09) * Math.cos(phi) + 0.05 * Math.cos(phi + turn), place.y + (length - 0.09) * Math.sin(phi) + 0.05 * Math.sin(phi + turn));
    const d = `${through([this.map(place.x, place.y), tip])}${through([barb(Math.PI / 2), tip, barb(-Math.PI / 2)])}`;
    return svg("path", { class: kind, fill: "none", style: "fill:none", d });
  }

  /** The range of a free heading, on the side from which the robot would come. */
  arc(place, parameter) {
    const points = [];
    const steps = 48;
    for (let k = 0; k <= steps; k += 1) {
      const phi = parameter.lower + ((parameter.upper - parameter.lower) * k) / steps + Math.PI;
      points.push(this.map(place.x + RING_M[0] * Math.cos(phi), place.y + RING_M[0] * Math.sin(phi)));
    }
    return svg("path", { class: "range", d: through(points) });
  }

  /** The objective by heading: a petal on the side from which the robot would come, the longer the better. */
  petals(place, said) {
    const known = said.cost.filter((cost) => cost !== null);
    const [best, worst] = [Math.min(...known), Math.max(...known)];
    return said.values.map((phi, i) => {
      const good = said.cost[i] === null ? 0 : (worst - said.cost[i]) / (worst - best || 1);
      const [inner, outer] = [RING_M[0], RING_M[0] + 0.02 + (RING_M[1] - RING_M[0]) * good];
      const [c, s] = [Math.cos(phi + Math.PI), Math.sin(phi + Math.PI)];
      const d = through([this.map(place.x + inner * c, place.y + inner * s), this.map(place.x + outer * c, place.y + outer * s)]);
      const paint = said.cost[i] !== null ? `color-mix(in oklab, var(--good) ${Math.round(100 * good ** 2)}%, var(--faint))` : "var(--line)";
      return svg("path", { class: "petal", style: `stroke:${paint};opacity:${0.35 + 0.5 * good}`, d });
    });
  }

  robot(pose) {
    const [length, breadth] = ROBOT;
    const corner = (ahead, left) => this.map(pose.x + ahead * Math.cos(pose.phi) - left * Math.sin(pose.phi), pose.y + ahead * Math.sin(pose.phi) + left * Math.cos(pose.phi));
    const body = [corner(length / 2, breadth / 2.6), corner(length / 4, breadth / 2), corner(-length / 2, breadth / 2), corner(-length / 2, -breadth / 2), corner(length / 4, -breadth / 2), corner(length / 2, -breadth / 2.6)];
    return [svg("path", { class: "robot", d: `${through(body)}Z` }), svg("path", { class: "robot nose", d: through([corner(0, 0), corner(length / 2, 0)]) })];
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
    return legend([...pairs, ...(this.run.source() === "truth" ? [["idle", "dotted: as believed"]] : [])]);
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
