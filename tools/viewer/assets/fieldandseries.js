// The scene of a robot without a heading on the plane, such as an arm, above the values of its belief over time.

class FieldAndSeries {
  constructor(run, target) {
    const [above, below] = [html("div"), html("div")];
    target.body.replaceChildren(above, below);
    this.field = new Field(run, { ...target, body: above });
    this.series = new Series(run, { title: html("span"), note: html("small"), body: below });
  }

  show(at, view) {
    this.field.show(at);
    this.series.show(at, view);
  }
}
