// Samples packed into columns by columns.py: whole numbers, the first value and then differences.

const DIGITS = { at: 1e3, values: 1e4 };

/** The samples of a block as rows: {at, ...fields}. */
function unpacked(block) {
  const count = block.length;
  const at = unpackedColumn(block.at, DIGITS.at, count);
  const columns = block.columns.map((column) => unpackedColumn(column, DIGITS.values, count));
  const value = reader(block.like, columns);
  return Array.from(at, (seconds, i) => ({ at: seconds, ...value(i) }));
}

/** Values of a column; differences of 0 at its end are not written. */
function unpackedColumn(column, factor, count) {
  if (column.plain) return column.plain;
  const values = new Array(count);
  let sum = 0;
  for (let i = 0; i < count; i += 1) {
    sum += column[i] ?? 0;
    values[i] = sum / factor;
  }
  return values;
}

/** A function that makes the fields of one sample, in the form that `like` gives. */
function reader(like, columns) {
  if (typeof like === "number") return (i) => columns[like][i];
  if (Array.isArray(like)) {
    const parts = like.map((part) => reader(part, columns));
    return (i) => parts.map((part) => part(i));
  }
  const parts = Object.entries(like).map(([name, part]) => [name, reader(part, columns)]);
  return (i) => {
    const table = {};
    for (const [name, part] of parts) table[name] = part(i);
    return table;
  };
}

/** How many of the items, in order of time, are at most as late. */
function countUpTo(items, at, timeOf) {
  let low = 0;
  let high = items.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (timeOf(items[middle]) <= at) low = middle + 1;
    else high = middle;
  }
  return low;
}
