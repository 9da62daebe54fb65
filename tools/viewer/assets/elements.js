// Making elements: the only place that touches the document's namespaces. Text is always set as text, never as markup.

const SVG = "http://www.w3.org/2000/svg";

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null) continue;
    if (name === "text") element.textContent = value;
    else if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/** An SVG element; `text` is its text, `on...` its listeners, the rest attributes. */
function svg(name, attributes = {}, ...children) {
  return fill(document.createElementNS(SVG, name), attributes, children);
}

/** An HTML element, likewise. */
function html(name, attributes = {}, ...children) {
  return fill(document.createElement(name), attributes, children);
}

/** The panel with this id: its body to fill and a line beside its heading. Its heading folds it. */
function panel(id) {
  const section = document.getElementById(id);
  const heading = section.querySelector("h2");
  if (!heading.querySelector(".fold")) foldable(section, heading); // a live page may take a panel again
  return {
    section,
    title: section.querySelector("h2 span"),
    note: section.querySelector("h2 small"),
    body: section.querySelector(".body"),
  };
}

function foldable(section, heading) {
  const title = heading.querySelector("span");
  title.id = `${section.id}-title`;
  const named = { "aria-expanded": true, "aria-labelledby": title.id }; // the scene of an arm has another title
  const fold = html("button", { type: "button", class: "fold", ...named });
  heading.prepend(fold);
  heading.addEventListener("click", () => {
    fold.setAttribute("aria-expanded", !section.classList.toggle("folded"));
    dispatchEvent(new Event("resize")); // what was hidden may be out of date
  });
}

/** A legend: [class, words] pairs. */
function legend(pairs) {
  return html("span", { class: "legend" }, ...pairs.map(([kind, words]) => html("i", { class: kind, text: words })));
}

/** Seconds with two digits; a dash where there is no number. */
function seconds(value, digits = 2) {
  return value === null || value === undefined ? "–" : `${value.toFixed(digits)} s`;
}

/** A number and its noun: "1 check", "2 checks". */
function counted(number, noun) {
  return `${number} ${noun}${number === 1 ? "" : "s"}`;
}

/** A number with so many digits; what rounds to zero has no sign. */
function rounded(value, digits) {
  return value.toFixed(digits).replace(/^-(?=[0.]*$)/, "");
}

/** A difference in seconds with its sign. */
function signed(value, digits = 1) {
  const text = rounded(value, digits);
  return `${text.startsWith("-") ? text.replace("-", "−") : `+${text}`} s`;
}

/** A value in its unit; radians as degrees, which people read; "1" is none. */
function quantity(value, unit) {
  if (value === null || value === undefined) return "–";
  if (unit === "rad") return `${rounded((value * 180) / Math.PI, 0)}°`;
  return unit === "1" ? rounded(value, 2) : `${rounded(value, 2)} ${unit}`.trim();
}

/** A path of straight lines through points; a null breaks it. */
function through(points) {
  let path = "";
  let pen = "M";
  for (const point of points) {
    if (point === null) {
      pen = "M";
      continue;
    }
    path += `${pen}${point[0].toFixed(2)} ${point[1].toFixed(2)}`;
    pen = "L";
  }
  return path;
}
