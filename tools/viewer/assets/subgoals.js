// Subgoals on the field: where they are, where they point, and what else was to be had where they were free.

const RING_M = [0.3, 0.62]; // where the alternatives' petals stand around a place
const LABEL_PX = [56, 14]; // room of a name
const LETTER_PX = 8;

class SubgoalMarks {
  /** `map` takes metres to pixels. */
  constructor(run, map) {
    this.run = run;
    this.map = map;
  }

  /** The parts to draw at a moment, names last so that nothing covers them. */
  at(at) {
    const why = this.run.last("why", at);
    const places = placesOf(this.run.last("subgoals", at)).filter((place) => place.goal);
    return [...places.flatMap((place) => this.place(place, at, why)), ...this.labels(places)];
  }

  /** A subgoal: an arrow where it points; where it is free also its range, its alternatives and greedy's choice. */
  place(place, at, why) {
    const free = place.free.length > 0;
    const heading = place.free.find((p) => p.quantity === "phi");
    const parts = [];
    if (heading) {
      const alternatives = why?.parameters.find((a) => a.place === place.label && a.quantity === "phi");
      parts.push(...(alternatives ? this.petals(place, alternatives) : [this.arc(place, heading)]));
      for (const phi of earlierHeadings(this.run, at, place.label))
        parts.push(this.arrow(place, phi, "place free before", 0.3));
      if (alternatives) parts.push(this.arrow(place, alternatives.greedy, "place lone", 0.34));
    }
    const [x, y] = this.map(place.x, place.y);
    if (Number.isFinite(place.phi)) parts.push(this.arrow(place, place.phi, free ? "place free" : "place", 0.36));
    parts.push(svg("circle", { class: free ? "place free" : "place", cx: x, cy: y, r: 2.2 }));
    if (place.target) parts.push(...this.target(place));
    return parts;
  }

  /** Where the robot is to work from a place: a cross, and a thin line to it. */
  target(place) {
    const [x, y] = this.map(...place.target);
    const cross = `${through([[x - 4, y - 4], [x + 4, y + 4]])}${through([[x - 4, y + 4], [x + 4, y - 4]])}`;
    return [
      svg("path", { class: "range", d: through([this.map(place.x, place.y), [x, y]]) }),
      svg("path", { class: place.free.length > 0 ? "place free" : "place", d: cross }),
    ];
  }

  /** Names below their places, to the left of those at the right edge; names beside each other are apart. */
  labels(places) {
    const taken = [];
    const [left, right] = this.map.box;
    const edge = (right - left) * this.map.perMetre;
    return places.map((place) => {
      const [x, y] = this.map(place.x, place.y);
      let low = y + 17;
      while (taken.some(([a, b]) => Math.abs(a - x) < LABEL_PX[0] && Math.abs(b - low) < LABEL_PX[1])) low += LABEL_PX[1];
      taken.push([x, low]);
      const side = x + 9 + LETTER_PX * place.label.length > edge ? { x: x - 9, "text-anchor": "end" } : { x: x + 9 };
      return svg("text", { class: "strong halo", ...side, y: low, text: place.label });
    });
  }

  arrow(place, phi, kind, length) {
    const tip = this.map(place.x + length * Math.cos(phi), place.y + length * Math.sin(phi));
    const barb = (turn) =>
      this.map(
        place.x + (length - 0.09) * Math.cos(phi) + 0.05 * Math.cos(phi + turn),
        place.y + (length - 0.09) * Math.sin(phi) + 0.05 * Math.sin(phi + turn),
      );
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
  petals(place, alternatives) {
    const known = alternatives.cost.filter((cost) => cost !== null);
    const [best, worst] = [Math.min(...known), Math.max(...known)];
    return alternatives.values.map((phi, i) => {
      const good = alternatives.cost[i] === null ? 0 : (worst - alternatives.cost[i]) / (worst - best || 1);
      const [inner, outer] = [RING_M[0], RING_M[0] + 0.02 + (RING_M[1] - RING_M[0]) * good];
      const [c, s] = [Math.cos(phi + Math.PI), Math.sin(phi + Math.PI)];
      const d = through([
        this.map(place.x + inner * c, place.y + inner * s),
        this.map(place.x + outer * c, place.y + outer * s),
      ]);
      const paint =
        alternatives.cost[i] !== null
          ? `color-mix(in oklab, var(--good) ${Math.round(100 * good ** 2)}%, var(--faint))`
          : "var(--line)";
      return svg("path", { class: "petal", style: `stroke:${paint};opacity:${0.35 + 0.5 * good}`, d });
    });
  }
}
