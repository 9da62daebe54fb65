// The run as it was told: rows by kind, in order of time. Knows nothing of drawing.

const SOURCES = ["truth", "believed", "seen", "odom"]; // where a robot on the plane may be known from, best first

class Run {
  constructor() {
    this.kinds = new Map();
    this.start = 0;
    this.end = 0;
    this.version = 0; // changes with every row that came
  }

  /** Take in one row as the server writes it: [at, kind, fields]. */
  add([at, kind, fields]) {
    if (!this.kinds.has(kind)) this.kinds.set(kind, []);
    const rows = this.kinds.get(kind);
    const row = { at, ...fields };
    if (rows.length && rows[rows.length - 1].at > at) rows.splice(this.count(kind, at), 0, row);
    else rows.push(row);
    this.end = Math.max(this.end, at);
    this.version += 1;
  }

  all(kind) {
    return this.kinds.get(kind) ?? [];
  }

  /** How many rows of a kind there are up to a time, that time included. */
  count(kind, at) {
    const rows = this.all(kind);
    let low = 0;
    let high = rows.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (rows[middle].at <= at) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** The newest row of a kind at a time, or null. */
  last(kind, at = Infinity) {
    return this.all(kind)[this.count(kind, at) - 1] ?? null;
  }

  /** The rows of a kind from a time to a time. */
  between(kind, from, to) {
    return this.all(kind).slice(this.count(kind, from - 1e-9), this.count(kind, to));
  }

  about() {
    return this.last("about") ?? {};
  }

  /** The best source of the robot's pose on the plane, or null for a robot that is no point on it. */
  source() {
    return SOURCES.find((source) => this.all(source).length > 0) ?? null;
  }

  /** Kinds that are plain series of numbers: topics that the page does not know. */
  series() {
    return [...this.kinds.keys()].filter((kind) => kind.startsWith("series "));
  }

  /** Every action that was started: when it began, ended and was predicted to end. */
  actions() {
    if (this.actionsOf === this.version) return this.known;
    const started = this.all("action");
    const found = [];
    started.forEach((row, position) => {
      if (row.index < 0) return;
      const next = started[position + 1]?.at ?? Infinity;
      const ended =
        this.all("finished").find((end) => end.index === row.index && end.at >= row.at - 0.3 && end.at <= next + 0.3) ??
        null;
      const first = this.all("belief")[this.count("belief", row.at - 1e-9)];
      const begin = first ? first.at - first.elapsed : row.at;
      const until = ended ? begin + ended.actual : Math.min(next, this.end);
      found.push({
        index: row.index,
        action: row.action,
        begin,
        until,
        ended,
        predicted: ended?.predicted ?? first?.predicted ?? 0,
      });
    });
    this.actionsOf = this.version;
    this.known = found;
    return found;
  }

  /** When each episode begins: the first at the start, the others where the count of actions begins anew. */
  episodes() {
    const starts = [this.start];
    this.actions().forEach((action, i, all) => {
      if (i > 0 && action.index <= all[i - 1].index) starts.push(action.begin);
    });
    return starts;
  }

  /** The stretch of time of the episode at a moment: [from, to). */
  episode(at) {
    const starts = this.episodes();
    const number = Math.max(0, starts.filter((start) => start <= at).length - 1);
    return [starts[number], starts[number + 1] ?? Infinity];
  }

  /** Times at which something happened, for jumping to. */
  landmarks() {
    const kinds = ["state", "plan", "action", "finished", "subgoals", "estop"];
    return [...new Set(kinds.flatMap((kind) => this.all(kind).map((row) => row.at)))].sort((a, b) => a - b);
  }
}

/** The colour class of an action by its place in the run. */
function colour(index) {
  return index < 0 ? "idle" : `c${index % 6}`;
}
