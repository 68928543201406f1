// The controls around a view: scale slider, layers, buttons, panes' names, what was chosen.
import { CurveTable } from "./curve_table.js";
import { element } from "./elements.js";
import { angleClasses, jacobianClasses, palette } from "./palette.js";

const layers = [
  { name: "surface", text: "Surface", isOn: true },
  { name: "edges", text: "Mesh edges", isOn: true },
  { name: "quality", text: "Colour by quality", isOn: false },
  { name: "initial", text: "Initial network", isOn: false, color: palette.initial },
  { name: "adapted", text: "Adapted network", isOn: true, color: palette.adapted },
  { name: "dropped", text: "Dropped pieces", isOn: true, color: palette.dropped },
  { name: "conflicts", text: "Conflicts", isOn: false, color: palette.conflicts },
];

// Of models of which quads were made.
const quadLayers = [
  { name: "field", text: "Cross field", isOn: false, color: palette.field },
  {
    name: "singularities", text: "Irregular vertices", isOn: true,
    color: `linear-gradient(90deg, ${palette.fewerQuads} 50%, ${palette.moreQuads} 50%)`,
  },
];

export function layersOf(model) {
  return model.has_quads ? [...layers, ...quadLayers] : layers;
}

const helpRows = [
  ["Turn", "drag, one finger, arrow keys"],
  ["Shift", "right button, two fingers, Shift + arrow keys"],
  ["Magnify", "wheel (after a click), pinch, + and −"],
  ["Roll", "comma and full stop"],
  ["Home view", "0"],
  ["Scale", "[ and ]"],
  ["Layers", "1 to 7 (9 with quads)"],
  ["Compare", "C"],
  ["Save picture", "S"],
  ["Ask", "point, click or tap on a curve; Escape lets go"],
];

export class Controls {
  constructor(root, id, name, layers, count, on) {
    this.id = id;
    this.layers = layers;
    this.on = on;
    this.canvas = element("canvas", {
      tabindex: 0,
      role: "application",
      "aria-label": `3D view of ${name}. Arrow keys turn, plus and minus magnify, 0 is the home view.`,
    });
    this.tip = element("div", { class: "v-tip", hidden: true });
    this.table = new CurveTable(id, on.curve);
    this.slider = element("input", {
      type: "range", id: `${id}-scale`, min: 0, max: count, step: 1, value: Math.min(1, count),
      oninput: () => on.level(Number(this.slider.value)),
    });
    this.scale = element("output", { for: `${id}-scale`, class: "v-scale" });
    this.facts = element("p", { class: "v-facts" });
    this.quads = element("p", { class: "v-facts", hidden: true });
    this.compare = this.button("Compare", "Two meshes side by side", on.compare);
    this.compare.setAttribute("aria-pressed", "false");
    this.panes = [0, 1].map((pane) => this.pane(pane));
    this.chosen = element("div", { class: "v-chosen", "aria-live": "polite" });
    root.replaceChildren(this.toolbar(), this.frame(), this.side());
  }

  button(text, title, clicked) {
    return element("button", { type: "button", title, onclick: clicked }, text);
  }

  toolbar() {
    return element(
      "div",
      { class: "v-bar" },
      element("label", { for: this.slider.id }, "Scale"),
      this.slider,
      this.scale,
      element(
        "span",
        { class: "v-buttons" },
        this.compare,
        this.button("Home view", "Back to the first view (0)", this.on.home),
        this.button("Save picture", "PNG of what is shown (S)", this.on.save),
        this.button("Full screen", "The view alone", this.on.full),
      ),
      this.facts,
      this.quads,
    );
  }

  pane(number) {
    const select = element("select", {
      "aria-label": number === 0 ? "Surface shown" : "Surface shown on the right",
      onchange: () => this.on.surface(number, select.value),
    });
    const facts = element("p", { class: "v-facts" });
    const root = element("div", { class: "v-pane", hidden: number > 0 }, select, facts);
    return { root, select, facts };
  }

  frame() {
    return element(
      "div",
      { class: "v-frame" },
      element("div", { class: "v-panes" }, ...this.panes.map((pane) => pane.root)),
      element("div", { class: "v-stage" }, this.canvas, this.tip),
    );
  }

  side() {
    this.boxes = this.layers.map((layer, k) => this.box(layer, k));
    return element(
      "div",
      { class: "v-side" },
      element("fieldset", {}, element("legend", {}, "Show"), ...this.boxes.map((b) => b.label)),
      ...this.legends(),
      element("h3", {}, "Chosen"),
      this.chosen,
      this.table.root,
      this.help(),
    );
  }

  box({ name, text, isOn, color }, k) {
    const box = element("input", {
      type: "checkbox", name, checked: isOn,
      onchange: () => this.on.layer(name, box.checked),
    });
    const swatch = color && element("i", { style: `background:${color}` });
    const label = element("label", { title: `Key ${k + 1}` }, box, swatch, text);
    return { name, box, label };
  }

  // What the colours of quality mean, for triangles and for quads.
  legends() {
    const legend = (classes, title) =>
      element(
        "div",
        { class: "v-legend", hidden: true },
        element("p", { class: "v-hint" }, title),
        element(
          "ul",
          {},
          ...classes.map(({ color, name }) =>
            element("li", {}, element("i", { style: `background:${color}` }), name),
          ),
        ),
      );
    this.angles = legend(angleClasses, "Smallest angle of a triangle");
    this.jacobians = legend(jacobianClasses, "Scaled Jacobian of a quad");
    return [this.angles, this.jacobians];
  }

  // `sides` of the faces that are coloured; none: no legend.
  setLegends(sides) {
    this.angles.hidden = !sides.includes(3);
    this.jacobians.hidden = !sides.includes(4);
  }

  help() {
    const rows = helpRows.map(([what, how]) => [element("dt", {}, what), element("dd", {}, how)]);
    return element(
      "details",
      { class: "v-help" },
      element("summary", {}, "Mouse, touch, keys"),
      element("dl", {}, ...rows.flat()),
    );
  }

  // Layers that this level has nothing of cannot be switched.
  setAvailable(name, isAvailable) {
    const found = this.boxes.find((box) => box.name === name);
    if (found) found.box.disabled = !isAvailable;
  }

  setChosen(description) {
    if (!description) {
      const hint = "Point at a curve, click or tap it, or choose one from the table.";
      this.chosen.replaceChildren(element("p", { class: "v-hint" }, hint));
      return;
    }
    this.chosen.replaceChildren(...card(description));
  }

  setTip(description, x, y) {
    this.tip.hidden = !description;
    if (!description) return;
    this.tip.replaceChildren(...card(description));
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const left = Math.min(x + 14, Math.max(4, width - this.tip.offsetWidth - 4));
    const below = y + 16 + this.tip.offsetHeight < height;
    this.tip.style.left = `${left}px`;
    this.tip.style.top = `${below ? y + 16 : Math.max(4, y - this.tip.offsetHeight - 10)}px`;
  }
}

function card({ title, facts }) {
  return [
    element("strong", {}, title),
    element("ul", {}, ...facts.map((fact) => element("li", {}, fact))),
  ];
}
