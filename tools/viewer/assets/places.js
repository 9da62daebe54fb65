// Subgoals on the page: a label with the place that the robot's scene gives it, maybe a heading.

/** The places of a subgoals row by label: {label, x, y, phi, free: [parameter], goal: whether an action ends there}. */
function placesOf(row) {
  const places = new Map();
  for (const action of row?.actions ?? []) {
    const start = action.parameters[0]?.place;
    for (const parameter of action.parameters) {
      const place = places.get(parameter.place) ?? { label: parameter.place, free: [], goal: false };
      if (!(parameter.quantity in place)) {
        place[parameter.quantity] = parameter.value;
        if (!parameter.bound) place.free.push(parameter);
      }
      place.goal ||= parameter.place !== start;
      places.set(parameter.place, place);
    }
  }
  for (const place of places.values()) {
    [place.x, place.y] = row.places?.[place.label] ?? [null, null];
    place.target = row.targets?.[place.label] ?? null; // where the robot is to work from there
  }
  return [...places.values()].filter((place) => Number.isFinite(place.x) && Number.isFinite(place.y));
}

/** Headings chosen earlier for a free place in the same action, oldest first, without the one that stands. */
function earlierHeadings(run, at, label) {
  const now = run.last("subgoals", at);
  const since = Math.max(
    0,
    ...run
      .all("action")
      .filter((row) => row.index < 0 && row.at < at)
      .map((row) => row.at),
  );
  const found = [];
  for (const row of run.between("subgoals", since, at)) {
    const place = placesOf(row).find((other) => other.label === label);
    if (row !== now && place && Number.isFinite(place.phi)) found.push(place.phi);
  }
  return found.slice(-12);
}
