// The curves of the initial network and what became of each at this level; a click on a row shows it.
import { number, percent } from "./describe.js";
import { element } from "./elements.js";

const rowsAtFirst = 60;

// One row a curve, what lost most first.
export function curveRows(levels, level) {
  const lengths = levels.model.curve_length;
  const rows = lengths.map((length, curve) => ({ curve, length, kept: null, pieces: 0 }));
  if (!level) return rows.sort((a, b) => b.length - a.length || a.curve - b.curve);
  rows.forEach((row) => (row.kept = Math.min(1, level.curve_kept[row.curve] / (row.length || 1))));
  level.dropped.curve.forEach((curve) => {
    if (curve >= 0) ++rows[curve].pieces;
  });
  const lost = (row) => row.length * (1 - row.kept);
  return rows.sort((a, b) => lost(b) - lost(a) || b.length - a.length || a.curve - b.curve);
}

export class CurveTable {
  constructor(id, chosen) {
    this.chosen = chosen;
    this.body = element("tbody");
    this.more = element("button", { type: "button", onclick: () => this.showAll() }, "Show all");
    this.root = element(
      "div",
      { class: "v-curves" },
      element("h3", { id: `${id}-curves` }, "Curves"),
      element("p", { class: "v-hint" }, "What lost most comes first. Choose one to see it."),
      element(
        "div",
        { class: "v-scroll", tabindex: 0, role: "region", "aria-labelledby": `${id}-curves` },
        element(
          "table",
          {},
          element(
            "thead",
            {},
            element(
              "tr",
              {},
              ...["Curve", "Length", "Kept", "Dropped"].map((text) =>
                element("th", { scope: "col" }, text),
              ),
            ),
          ),
          this.body,
        ),
        this.more,
      ),
    );
  }

  fill(levels, level) {
    this.rows = curveRows(levels, level);
    this.body.replaceChildren(...this.rows.slice(0, rowsAtFirst).map((row) => this.row(row)));
    this.more.hidden = this.rows.length <= rowsAtFirst;
    this.more.textContent = `Show all ${this.rows.length}`;
  }

  showAll() {
    this.body.append(...this.rows.slice(rowsAtFirst).map((row) => this.row(row)));
    this.more.hidden = true;
  }

  row({ curve, length, kept, pieces }) {
    const button = element(
      "button",
      { type: "button", "aria-pressed": "false", "aria-label": `Curve ${curve}` },
      String(curve),
    );
    const row = element(
      "tr",
      { "data-curve": curve, onclick: () => this.chosen(curve) },
      element("th", { scope: "row" }, button),
      element("td", {}, number(length)),
      element("td", {}, kept === null ? "–" : percent(kept, 0)),
      element("td", {}, kept === null ? "–" : String(pieces)),
    );
    return row;
  }

  // Marks the row of a curve and brings it into the table's window.
  mark(curve) {
    if (curve !== null && this.rows.findIndex((row) => row.curve === curve) >= rowsAtFirst)
      if (!this.more.hidden) this.showAll();
    for (const row of this.body.children) {
      const isMarked = Number(row.dataset.curve) === curve;
      row.classList.toggle("v-marked", isMarked);
      row.querySelector("button").setAttribute("aria-pressed", String(isMarked));
      if (isMarked) {
        const window = row.closest(".v-scroll");
        const [top, bottom] = [row.offsetTop, row.offsetTop + row.offsetHeight];
        if (top < window.scrollTop + 30 || bottom > window.scrollTop + window.clientHeight)
          window.scrollTop = top - window.clientHeight / 2;
      }
    }
  }
}
