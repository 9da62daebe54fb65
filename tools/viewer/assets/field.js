// The scene on a plane: shapes that the robot's package draws, and its way. From above like the paper's Figure 1: lines
// across the heading, whose length is the speed. A robot without a heading, such as an arm's pen, leaves a line.

const MOST_PX = 760; // width of the drawing
const LINE_S = 0.32; // metres of line for each metre a second: 0.9 m/s draws 0.29 m

class Field {
  constructor(run, target) {
    this.run = run;
    this.panel = target;
    this.drawn = "";
    this.layers = html("div", { class: "layers" });
  }

  /** Show a time. Static parts are redrawn only after new events, for another episode, or in another width. */
  show(at) {
    if (!this.layers.isConnected) this.panel.body.replaceChildren(this.layers);
    // Not that of the panel, which may be wider: its words would shrink with the drawing. A folded panel has none.
    this.width = Math.min(MOST_PX, this.layers.clientWidth || this.width || MOST_PX);
    if (this.drawn !== `${this.run.version} ${this.width}`) this.lay();
    const [from, to] = this.run.episode(at);
    if (from !== this.from) this.layEpisode(from, to);
    this.colourStrokes(at);
    this.moving.replaceChildren(...this.movingParts(at));
  }

  /** The frame of the run: two layers, so that moving parts do not repaint static ones. */
  lay() {
    this.drawn = `${this.run.version} ${this.width}`;
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
    const words = svg("g", { class: "numbers" }, ...this.numbers(width, height)); // last: walls would cover them
    const above = svg("svg", { viewBox: box, class: "above", "aria-hidden": "true" }, this.moving, words);
    this.layers.replaceChildren(below, above);
    this.panel.title.textContent = "Scene";
    this.panel.note.replaceChildren(this.legend());
  }

  /** Path of one episode: a drawing for each action, pale in the future. */
  layEpisode(from, to) {
    this.from = from;
    this.pieces = this.run.pieces(this.run.source(), from, to);
    this.path = this.pieces.flat();
    this.segments = this.pieces.flatMap(segmentsOf);
    for (const segment of this.segments) segment.element = svg("path", { d: this.way(segment.points) });
    const known = this.run.nextAction(from); // before that the executive may still be looking for where the robot is
    const ghosts = this.run.source() === "truth" ? this.run.pieces("believed", known, to) : [];
    this.still.replaceChildren(
      ...this.segments.map((s) => s.element),
      svg("path", { class: "ghost", d: this.lines(ghosts, (p) => [p.x, p.y]) }),
      ...this.objectPaths(),
    );
  }

  /** Path and start of every object: of shapes that are no part of the robot and more than a line. */
  objectPaths() {
    const names = new Set(this.path.flatMap((p) => Object.keys(p.places ?? {})));
    return [...names].flatMap((name) => {
      const outline = this.outline(name, Infinity);
      if (outline.robots || !outline.closed) return [];
      const first = this.path.find((p) => p.places?.[name]).places[name];
      const d = this.lines(this.pieces, (p) => p.places?.[name]);
      return [
        svg("path", { class: "objectpath", style: `stroke:${outline.colour}`, d }),
        svg("path", { class: "objectstart", style: `stroke:${outline.colour}`, d: this.corners(outline, first) }),
      ];
    });
  }

  /** A line through each of several pieces, also broken where a sample has no place. */
  lines(pieces, placeOf) {
    const points = (piece) => piece.map(placeOf).map((place) => (place ? this.map(...place) : null));
    return pieces.map((piece) => through(points(piece))).join("");
  }

  colourStrokes(at) {
    for (const segment of this.segments) {
      const ahead = segment.points[segment.points.length - 1].at > at;
      const kind = `${this.headed ? "strokes" : "trace"} ${ahead ? "ahead " : ""}${colour(segment.index)}`;
      if (segment.element.getAttribute("class") !== kind) segment.element.setAttribute("class", kind);
    }
  }

  /** Map from metres to pixels: all drawn places, with a margin, y upwards. */
  frame() {
    const path = this.run.all(this.run.source());
    const places = this.run.all("subgoals").flatMap(placesOf);
    this.headed = path.some((p) => p.phi !== null);
    const objects = path.flatMap((p) => this.objectCorners(p));
    const xs = [...path.map((p) => p.x), ...places.map((p) => p.x), ...objects.map((o) => o[0])];
    const ys = [...path.map((p) => p.y), ...places.map((p) => p.y), ...objects.map((o) => o[1])];
    let [left, right] = extent(xs, 0);
    let [bottom, top] = extent(ys, 0);
    const margin = this.headed ? 0.55 : 0.12;
    [left, right, bottom, top] = [left - margin, right + margin, bottom - margin, top + margin];
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
    const width = this.width;
    const perMetre = width / (right - left);
    const height = (top - bottom) * perMetre;
    const map = (x, y) => [(x - left) * perMetre, (top - y) * perMetre];
    map.perMetre = perMetre;
    map.box = [left, right, bottom, top];
    return { map, width, height };
  }

  gridLines(width, height) {
    const { xs, ys } = this.axes(width);
    const vertical = xs.map(([, px]) => svg("line", { class: "grid", x1: px, x2: px, y1: 0, y2: height }));
    return [...vertical, ...ys.map(([, py]) => svg("line", { class: "grid", x1: 0, x2: width, y1: py, y2: py }))];
  }

  /** The numbers of both axes, and their unit. */
  numbers(width, height) {
    const { xs, ys } = this.axes(width);
    const inside = xs.filter(([, px]) => px >= 16 && px <= width - 16); // others would lie on those of y, or be cut
    const number = (x, y, value) => svg("text", { class: "halo", x, y, text: String(value) });
    const unit = { class: "halo", x: width - 4, y: 12, "text-anchor": "end", text: this.headed ? "x, y in m" : "m" };
    return [
      ...inside.map(([x, px]) => number(px + 3, height - 4, x)),
      ...ys.map(([y, py]) => number(3, py - 3, y)),
      svg("text", unit),
    ];
  }

  /** Round numbers of both axes with their pixels: [[number, pixel]]. */
  axes(width) {
    const [left, right, bottom, top] = this.map.box;
    return {
      xs: atLeastTwo(left, right, width / 95).map((x) => [x, this.map(x, 0)[0]]),
      ys: atLeastTwo(bottom, top, width / 125).map((y) => [y, this.map(0, y)[1]]),
    };
  }

  movingParts(at) {
    const parts = this.segments
      .filter((s) => s.points[0].at <= at && s.points[s.points.length - 1].at > at)
      .map((s) =>
        svg("path", {
          class: `${this.headed ? "strokes" : "trace"} ${colour(s.index)}`,
          d: this.way(s.points.filter((p) => p.at <= at)),
        }),
      );
    const now = this.run.last(this.run.source(), at);
    const shapes = now ? this.shapes(now, at) : [];
    return [...shapes.map((s) => s.element), ...parts, ...new SubgoalMarks(this.run, this.map).at(at)];
  }

  /** All shapes of a moment: those of the robot last, so that nothing hides it. */
  shapes(now, at) {
    const prefix = `outline ${this.run.source()} `;
    const names = [...this.run.kinds.keys()].filter((kind) => kind.startsWith(prefix)).map((k) => k.slice(prefix.length));
    return names
      .map((name) => ({ outline: this.outline(name, at), place: now.places?.[name] }))
      .filter(({ outline, place }) => outline && (place || outline.onRobot))
      .map(({ outline, place }) => ({
        robots: outline.robots,
        element: this.shape(outline, outline.onRobot ? [now.x, now.y, now.phi] : place),
      }))
      .sort((a, b) => a.robots - b.robots);
  }

  outline(name, at) {
    return this.run.last(`outline ${this.run.source()} ${name}`, at);
  }

  /** Corners of the things in a sample that are no part of the robot, metres. */
  objectCorners(sample) {
    return Object.entries(sample.places ?? {}).flatMap(([name, place]) => {
      const outline = this.outline(name, Infinity);
      return outline && outline.closed && !outline.robots ? placed(outline, place) : [];
    });
  }

  shape(outline, place) {
    if (outline.words) {
      const [x, y] = this.map(place[0], place[1]);
      return svg("text", { class: "strong halo", x, y, text: outline.words });
    }
    const d = this.corners(outline, place);
    if (!outline.closed) {
      const width = Math.max(1.2, outline.width * this.map.perMetre);
      return svg("path", {
        class: outline.robots ? "robot nose" : "backdrop",
        style: `stroke-width:${width.toFixed(1)}${outline.robots ? "" : `;stroke:${outline.colour}`}`,
        d,
      });
    }
    const pale = this.headed ? "" : " pale"; // an arm would hide what it writes
    return svg("path", { class: outline.robots ? `robot${pale}` : "object", style: `fill:${outline.colour}`, d });
  }

  /** The outline at a place: x, y and heading. */
  corners(outline, place) {
    const points = placed(outline, place).map(([x, y]) => this.map(x, y));
    return through(points) + (outline.closed ? "Z" : "");
  }

  /** The way of the robot: lines across its heading, or a line. */
  way(points) {
    return this.headed ? this.strokes(points) : through(points.map((p) => this.map(p.x, p.y)));
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

/** Points of an outline at a place (x, y and heading), metres. */
function placed(outline, [x, y, phi]) {
  const [c, s] = [Math.cos(phi ?? 0), Math.sin(phi ?? 0)];
  return outline.points.map(([a, b]) => [x + c * a - s * b, y + s * a + c * b]);
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
