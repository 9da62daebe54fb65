// The events of a run by kind, in order of time. Independent of drawing.

const SOURCES = ["truth", "believed", "seen", "odom"]; // sources of the robot's pose, best first

// Of a live run, as the viewer keeps it for new pages (broadcast.py): everything for KEEP_S; of what is older the newest
// events of each kind, so that a page of weeks does not grow.
const KEEP_S = 600;
const KEEP_EVENTS = 2000;
const MAX_RECENT = 20_000; // of each kind, also of KEEP_S: a flood has more
const FORGET_EVERY_S = 60;
const PASSING = new Set(["tick", "belief", ...SOURCES, "why"]);
const PASSING_STARTS = ["series ", "outline "];
const JUMP_M = 0.5; // two places so far apart,
const FASTEST_MPS = 3; // and farther than a robot drives meanwhile, are no path

class Run {
  constructor() {
    this.forgotAt = 0;
    this.kinds = new Map();
    this.start = 0;
    this.end = 0;
    this.version = 0; // changes with every event
    this.now = 0; // of a live run, by the viewer's last sign of life
    this.bus = true; // whether the viewer is connected to the bus
  }

  /** Add one event as the server writes it: [at, kind, fields]. */
  add([at, kind, fields]) {
    if (!this.kinds.has(kind)) this.kinds.set(kind, []);
    const rows = this.kinds.get(kind);
    const row = { at, ...fields };
    if (rows.length && rows[rows.length - 1].at > at) rows.splice(this.count(kind, at), 0, row);
    else rows.push(row);
    this.end = Math.max(this.end, at);
    this.version += 1;
  }

  /** Add a block of samples. */
  addSamples(block) {
    const samples = unpacked(block);
    if (!this.kinds.has(block.kind)) this.kinds.set(block.kind, []);
    const rows = this.kinds.get(block.kind);
    for (const row of samples) rows.push(row);
    this.end = Math.max(this.end, rows[rows.length - 1].at);
    this.version += samples.length;
  }

  /** A sign of life of the viewer, at a time of the run. */
  beat(at, { bus }) {
    this.now = at;
    this.bus = bus;
  }

  /** Parts of the system that are silent at a time, each with the seconds since their last message. */
  silent(at) {
    const now = at >= this.end ? Math.max(at, this.now) : at;
    const { at: _, ...parts } = this.last("silent", at) ?? {};
    return Object.entries(parts).map(([part, heard]) => [part, now - heard]);
  }

  /** Drop old events of a live run: a page of hours would take seconds for a frame, and so would its stop button. */
  forget() {
    if (this.end < this.forgotAt + FORGET_EVERY_S) return;
    this.forgotAt = this.end;
    for (const [kind, rows] of this.kinds) {
      const passes = PASSING.has(kind) || PASSING_STARTS.some((start) => kind.startsWith(start));
      const kept = passes ? 1 : KEEP_EVENTS; // the newest still holds, e.g. an outline
      const old = this.count(kind, this.end - KEEP_S);
      rows.splice(0, Math.max(0, Math.min(old, rows.length - kept), rows.length - MAX_RECENT));
    }
  }

  /** Number of events that are kept. */
  kept() {
    return [...this.kinds.values()].reduce((total, rows) => total + rows.length, 0);
  }

  all(kind) {
    return this.kinds.get(kind) ?? [];
  }

  /** Number of events of a kind up to a time, inclusive. */
  count(kind, at) {
    return countUpTo(this.all(kind), at, (row) => row.at);
  }

  /** The newest event of a kind at a time, or null. */
  last(kind, at = Infinity) {
    return this.all(kind)[this.count(kind, at) - 1] ?? null;
  }

  /** The events of a kind between two times. */
  between(kind, from, to) {
    return this.all(kind).slice(this.count(kind, from - 1e-9), this.count(kind, to));
  }

  /** Samples of a source of the pose between two times, in pieces: a simulator that starts anew begins elsewhere. */
  pieces(source, from, to) {
    return this.betweenRestarts(source, from, to).flatMap(unbroken);
  }

  /** The same between the restarts of a simulator. */
  betweenRestarts(source, from, to) {
    const restarts = this.between("restart", from, to).map((row) => row.at);
    if (restarts.length === 0) return [this.between(source, from, to)];
    const before = (at) => this.count(source, at - 1e-9);
    const begins = [from, ...restarts.map((at) => (source === "believed" ? this.nextAction(at) : at))];
    const ends = [...restarts.map(before), this.count(source, to)];
    return begins.map((begin, i) => this.all(source).slice(before(begin), ends[i]));
  }

  /** Time of the next action: by then the executive believes where a robot is that has started, or started anew. */
  nextAction(at) {
    const rows = this.all("action").slice(this.count("action", at - 1e-9));
    return rows.find((row) => row.index >= 0)?.at ?? Infinity;
  }

  /** Facts of the executive that ran at a time; before the first one, its. */
  about(at = Infinity) {
    return this.last("about", at) ?? this.all("about")[0] ?? {};
  }

  /** The best source of the robot's pose on the plane, or null without one. */
  source() {
    return SOURCES.find((source) => this.all(source).length > 0) ?? null;
  }

  /** Kinds that are series of numbers: topics without a view of their own. */
  series() {
    return [...this.kinds.keys()].filter((kind) => kind.startsWith("series "));
  }

  /** Every started action with its start, end and predicted duration. */
  actions() {
    if (this.actionsOf === this.version) return this.started;
    const started = this.all("action");
    const actions = [];
    started.forEach((row, position) => {
      if (row.index < 0) return;
      const next = started[position + 1]?.at ?? Infinity;
      const ended = this.between("finished", row.at - 0.3, next + 0.3).find((end) => end.index === row.index) ?? null;
      const reported = this.all("belief")[this.count("belief", row.at - 1e-9)];
      const first = reported?.at < (ended?.at ?? next) ? reported : null; // else those of this action are forgotten
      const reached = ended ? ended.at - ended.actual : row.at;
      const begin = first ? first.at - first.elapsed : reached;
      const until = ended ? begin + ended.actual : Math.min(next, this.end);
      actions.push({
        index: row.index,
        action: row.action,
        begin,
        until,
        ended,
        predicted: ended?.predicted ?? first?.predicted ?? 0,
      });
    });
    this.actionsOf = this.version;
    this.started = actions;
    return actions;
  }

  /** Starts of the episodes: the start of the run, and each restart of the action count. */
  episodes() {
    if (this.episodesOf === this.version) return this.starts;
    const starts = [this.start];
    this.actions().forEach((action, i, all) => {
      if (i > 0 && action.index <= all[i - 1].index) starts.push(action.begin);
    });
    this.episodesOf = this.version;
    this.starts = starts;
    return starts;
  }

  /** Interval of the episode at a time: [from, to). */
  episode(at) {
    const starts = this.episodes();
    const number = Math.max(0, starts.filter((start) => start <= at).length - 1);
    return [starts[number], starts[number + 1] ?? Infinity];
  }

  /** Times of events, as targets of jumps. */
  landmarks() {
    const kinds = ["state", "plan", "action", "finished", "subgoals", "estop"];
    return [...new Set(kinds.flatMap((kind) => this.all(kind).map((row) => row.at)))].sort((a, b) => a - b);
  }
}

/** The colour class of an action by its place in the run. */
function colour(index) {
  return index < 0 ? "idle" : `c${index % 6}`;
}

/** Samples of a path in pieces: one that was reset or carried off, or believes to be elsewhere, has not driven there. */
function unbroken(samples) {
  const broken = (p, q) => Math.hypot(q.x - p.x, q.y - p.y) > JUMP_M + FASTEST_MPS * (q.at - p.at);
  const pieces = [];
  for (const [i, sample] of samples.entries()) {
    if (i === 0 || broken(samples[i - 1], sample)) pieces.push([]);
    pieces[pieces.length - 1].push(sample);
  }
  return pieces;
}
