// One view: keeps what is shown (level, layers, surfaces, choice) and brings data, stage and controls
// together. Draws only when something has changed.
import { Controls, layersOf } from "./controls.js";
import { describe, meshFacts, number, percent } from "./describe.js";
import { element } from "./elements.js";
import { listen } from "./gestures.js";
import { Levels } from "./levels.js";
import { OrbitCamera } from "./orbit.js";
import { Stage } from "./stage.js";

export class Viewer {
  static async open(root, blocks) {
    const levels = await Levels.open(blocks);
    const viewer = new Viewer(root, levels);
    await viewer.setLevel(Math.min(1, levels.count));
    return viewer;
  }

  constructor(root, levels) {
    this.root = root;
    this.levels = levels;
    this.stage = new Stage(levels);
    const { toward, up } = levels.model.camera;
    this.orbit = new OrbitCamera(toward, up, levels.input.points);
    this.known = layersOf(levels.model);
    this.layers = Object.fromEntries(this.known.map(({ name, isOn }) => [name, isOn]));
    this.surfaces = [null, null];
    this.isComparing = false;
    this.choice = null;
    this.isAsking = false;
    this.controls = new Controls(root, root.id, levels.model.name, this.known, levels.count, {
      level: (value) => this.setLevel(value),
      layer: (name, isOn) => this.setLayer(name, isOn),
      surface: (pane, name) => this.setSurface(pane, name),
      curve: (curve) => this.chooseCurve(curve),
      compare: () => this.setComparing(!this.isComparing),
      home: () => this.goHome(),
      save: () => this.save(),
      full: () => this.goFullScreen(),
    });
    this.canvas = this.controls.canvas;
    this.context = this.canvas.getContext("2d");
    listen(this.canvas, this.orbit, {
      changed: () => this.invalidate(),
      hovered: (x, y) => this.hover(x, y),
      chosen: (x, y) => this.choosePoint(x, y),
      key: (key) => this.key(key),
    });
    new ResizeObserver(() => this.invalidate()).observe(this.canvas);
    this.controls.setChosen(null);
  }

  async setLevel(value) {
    this.wanted = value;
    const level = await this.levels.level(value);
    if (this.wanted !== value) return; // the slider has moved on
    this.number = value;
    this.level = level;
    this.stage.show(level);
    this.offerSurfaces();
    this.choose(this.choice?.curve === undefined ? null : { curve: this.choice.curve });
    this.controls.slider.value = value;
    this.writeFacts();
    for (const { name } of this.known)
      this.controls.setAvailable(name, !["field", "singularities"].includes(name) || level?.[name]);
    this.controls.table.fill(this.levels, level);
    this.controls.table.mark(this.choice?.curve ?? null);
    this.root.dataset.level = value;
    this.invalidate();
  }

  writeFacts() {
    const { scale, facts, slider } = this.controls;
    const { level } = this;
    this.controls.quads.hidden = !level?.quads;
    this.controls.quads.textContent = level?.quads ? `Quads: ${level.quads.words}` : "";
    const units = this.levels.model.units ? ` ${this.levels.model.units}` : "";
    scale.textContent = level ? level.label : "input";
    slider.setAttribute("aria-valuetext", scale.textContent);
    if (!level) {
      facts.textContent = `All that was detected: ${this.levels.initial.lines.count} arcs.`;
      return;
    }
    const shown = level.conflicts.lines.count;
    const conflicts =
      shown < level.conflicts.total
        ? `${level.conflicts.total} conflicts (${shown} shown)`
        : `${level.conflicts.total} conflicts`;
    facts.textContent = [
      `rmin ${number(level.rmin)}${units}`,
      `edge length ${number(level.edge_length)}${units}`,
      `${level.adapted.lines.count} segments kept`,
      `${level.dropped.lines.count} pieces dropped`,
      conflicts,
      `coverage ${percent(level.coverage)}`,
      level.violations === 0 ? "conforming" : `${level.violations} violations`,
    ].join(" · ");
  }

  // Both panes keep their surface if this level has one of that name.
  offerSurfaces() {
    const meshes = this.meshes();
    const fallback = [meshes[1] ?? meshes[0], meshes[2] ?? meshes[0]];
    this.controls.panes.forEach(({ select }, pane) => {
      select.replaceChildren(...meshes.map(({ name }) => element("option", { value: name }, name)));
      const wished = this.surfaces[pane];
      const shown = meshes.find(({ name }) => name === wished) ?? fallback[pane];
      select.value = shown.name;
    });
    this.writePanes();
  }

  meshes() {
    return [this.levels.input, ...(this.level?.meshes ?? [])];
  }

  writePanes() {
    for (const { select, facts } of this.controls.panes) {
      const mesh = this.meshes().find(({ name }) => name === select.value);
      facts.textContent = meshFacts(mesh, mesh === this.levels.input);
    }
    this.writeLegends();
  }

  writeLegends() {
    const shown = this.layers.quality ? this.views().map(({ surface }) => surface) : [];
    const meshes = this.meshes().filter(({ name }) => shown.includes(name));
    this.controls.setLegends(meshes.map(({ sides }) => sides ?? 3));
  }

  setSurface(pane, name) {
    this.surfaces[pane] = name;
    this.writePanes();
    this.invalidate();
  }

  setLayer(name, isOn) {
    this.layers[name] = isOn;
    this.controls.boxes.find((box) => box.name === name).box.checked = isOn;
    this.writeLegends();
    this.invalidate();
  }

  setComparing(isOn) {
    this.isComparing = isOn;
    this.controls.compare.setAttribute("aria-pressed", String(isOn));
    this.controls.panes[1].root.hidden = !isOn;
    this.canvas.dataset.panes = isOn ? 2 : 1;
    this.writeLegends();
    this.invalidate();
  }

  goHome() {
    this.orbit.reset();
    this.invalidate();
  }

  goFullScreen() {
    if (document.fullscreenElement) document.exitFullscreen();
    else this.root.requestFullscreen?.();
  }

  views() {
    const panes = this.isComparing ? this.controls.panes : this.controls.panes.slice(0, 1);
    const width = this.canvas.clientWidth / panes.length;
    const lineScale = Math.min(1, Math.max(0.55, width / 700));
    return panes.map(({ select }) => ({ surface: select.value, layers: this.layers, lineScale }));
  }

  invalidate() {
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame(() => {
      this.isWaiting = false;
      this.draw();
    });
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [w, h] = [Math.floor(width * ratio), Math.floor(height * ratio)];
    if (this.canvas.width !== w || this.canvas.height !== h)
      Object.assign(this.canvas, { width: w, height: h });
    const views = this.views();
    this.stage.draw(this.context, views, this.orbit, width, height, ratio);
    if (views.length === 2) {
      this.context.fillStyle = "#9aa5b1";
      this.context.fillRect(Math.floor(w / 2), 0, Math.ceil(ratio), h);
    }
    this.root.dataset.frames = Number(this.root.dataset.frames ?? 0) + 1;
  }

  // The curve at a place of the canvas.
  at(x, y) {
    const views = this.views();
    const width = this.canvas.clientWidth / views.length;
    const pane = Math.min(Math.floor(x / width), views.length - 1);
    const { clientHeight } = this.canvas;
    return this.stage.pick(views[pane], this.orbit, x - pane * width, y, width, clientHeight);
  }

  // At most one question a frame.
  hover(x, y) {
    this.pointer = x === null ? null : { x, y };
    if (this.isAsking) return;
    this.isAsking = true;
    requestAnimationFrame(() => {
      this.isAsking = false;
      const found = this.pointer && this.level !== undefined && this.at(this.pointer.x, this.pointer.y);
      this.canvas.style.cursor = found ? "pointer" : "grab";
      this.controls.setTip(
        found ? describe(found.layer, found.line, this.levels, this.level) : null,
        this.pointer?.x,
        this.pointer?.y,
      );
    });
  }

  choosePoint(x, y) {
    this.controls.setTip(null);
    const found = this.at(x, y);
    if (!found) return this.choose(null);
    const curves = this.stage.data(found.layer).curve;
    this.choose({ ...found, curve: curves?.[found.line] ?? undefined });
  }

  chooseCurve(curve) {
    this.choose(this.choice?.curve === curve && this.choice.line === undefined ? null : { curve });
  }

  // {layer, line, curve}: one polyline; {curve}: all of a curve; null: nothing.
  choose(choice) {
    this.choice = choice;
    this.controls.table.rows && this.controls.table.mark(choice?.curve ?? null);
    if (!choice) {
      this.stage.setHighlight(null);
      this.controls.setChosen(null);
    } else if (choice.line !== undefined) {
      this.stage.setHighlight({ [choice.layer]: (line) => line === choice.line });
      this.controls.setChosen(describe(choice.layer, choice.line, this.levels, this.level));
    } else {
      const isOfCurve = (name) => (line) => this.stage.data(name)?.curve?.[line] === choice.curve;
      this.stage.setHighlight({ initial: isOfCurve("initial") });
      this.controls.setChosen(this.describeCurve(choice.curve));
    }
    this.invalidate();
  }

  describeCurve(curve) {
    const { level } = this;
    const facts = [`length ${number(this.levels.model.curve_length[curve])}`];
    if (level) {
      const share = level.curve_kept[curve] / (this.levels.model.curve_length[curve] || 1);
      facts.push(`${percent(Math.min(1, share), 0)} of it kept`);
      const counts = new Map();
      level.dropped.curve.forEach((c, line) => {
        if (c !== curve) return;
        const reason = level.dropped.reasons[level.dropped.reason[line]];
        counts.set(reason, (counts.get(reason) ?? 0) + 1);
      });
      for (const [reason, count] of counts)
        facts.push(`dropped: ${count} ${count === 1 ? "piece" : "pieces"} (${reason})`);
    }
    return { title: `Curve ${curve}`, facts };
  }

  key(key) {
    const layer = this.known[Number(key) - 1];
    if (layer && /^[1-9]$/.test(key)) this.setLayer(layer.name, !this.layers[layer.name]);
    else if (key === "[") this.setLevel(Math.max(0, this.number - 1));
    else if (key === "]") this.setLevel(Math.min(this.levels.count, this.number + 1));
    else if (key === "c" || key === "C") this.setComparing(!this.isComparing);
    else if (key === "s" || key === "S") this.save();
    else if (key === "Escape") this.choose(null);
    else return false;
    return true;
  }

  save() {
    this.draw();
    this.canvas.toBlob((blob) => {
      const name = `${this.levels.model.name}-${this.level?.label ?? "input"}.png`;
      const address = URL.createObjectURL(blob);
      element("a", { href: address, download: name.replace(/[^\w.%-]+/g, "_") }).click();
      setTimeout(() => URL.revokeObjectURL(address), 10000);
    }, "image/png");
  }
}

