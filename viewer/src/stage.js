// What stands on the stage: surfaces, curve layers and the highlight of one level, and the drawing of
// them into one or two panes of a canvas. All views of a page share one WebGL context, since browsers
// allow few; each copies the picture into a canvas of its own.
import { Color, MeshBasicMaterial, Scene, WebGLRenderer, WebGLRenderTarget } from "three";
import { makeCurves, makeHighlight, makePickableCurves } from "./curves.js";
import { makeDots, makePickableDots, setRatio } from "./dots.js";
import { palette } from "./palette.js";
import { makeSurface } from "./surface.js";

const pickRadius = 4; // pixels
const background = new Color("#ffffff");
const nothing = new Color(0, 0, 0);
let renderer = null;

// Throws where there is no WebGL 2.
export function sharedRenderer() {
  if (!renderer) {
    renderer = new WebGLRenderer({ antialias: true, alpha: false, preserveDrawingBuffer: true });
    renderer.autoClear = false;
  }
  return renderer;
}

// Layers in the order of their numbers for picking.
export const layerNames = ["initial", "adapted", "dropped", "conflicts"];
// Nothing is asked of the field, so it cannot be picked.
const widths = { initial: 2, adapted: 3.2, dropped: 4, conflicts: 1.6, field: 1.8 };

export class Stage {
  constructor(levels) {
    this.levels = levels;
    this.scene = new Scene();
    this.pickScene = new Scene();
    this.occluder = new MeshBasicMaterial({ color: 0, side: 2 });
    this.target = new WebGLRenderTarget(2 * pickRadius + 1, 2 * pickRadius + 1);
    this.surfaces = new Map();
    this.layers = new Map();
    this.highlight = null;
    this.level = undefined;
    this.inputSurface = makeSurface(levels.input);
  }

  show(level) {
    this.clear();
    this.level = level;
    this.surfaces.set(this.levels.input.name, this.inputSurface);
    for (const mesh of level?.meshes ?? [])
      this.surfaces.set(mesh.name, makeSurface(mesh));
    for (const surface of this.surfaces.values()) {
      surface.visible = false;
      this.scene.add(surface);
    }
    let first = 1;
    for (const name of layerNames) {
      const data = this.data(name);
      if (!data) continue;
      const count = data.lines.count;
      const colorOf = (line) => (data.pinned?.[line] ? palette.pinned : palette[name]);
      const curves = makeCurves(data.lines, widths[name], colorOf);
      this.add({ name, data, first, count, curves },
               makePickableCurves(data.lines, widths[name], first));
      first += count;
    }
    const { field, singularities } = level ?? {};
    if (field) {
      const curves = makeCurves(field.lines, widths.field, () => palette.field);
      this.add({ name: "field", data: field, first: 0, count: 0, curves });
    }
    if (singularities?.valence.length)
      this.add({ name: "singularities", data: singularities, first,
                 count: singularities.valence.length, curves: makeDots(singularities) },
               makePickableDots(singularities, first));
  }

  add(layer, pickable = null) {
    this.layers.set(layer.name, { ...layer, pickable });
    this.scene.add(layer.curves);
    if (pickable) this.pickScene.add(pickable);
  }

  data(name) {
    return name === "initial" ? this.levels.initial : (this.level?.[name] ?? null);
  }

  clear() {
    this.setHighlight(null);
    for (const surface of this.surfaces.values())
      if (surface !== this.inputSurface) dispose(surface);
    for (const layer of this.layers.values()) {
      dispose(layer.curves);
      if (!layer.pickable) continue;
      dispose(layer.pickable);
      this.pickScene.remove(layer.pickable);
    }
    this.surfaces.clear();
    this.layers.clear();
    this.scene.clear();
  }

  // `chosen` gives, by layer, the test whether a polyline is meant; null takes the highlight away.
  setHighlight(chosen) {
    if (this.highlight) {
      this.scene.remove(this.highlight);
      dispose(this.highlight);
      this.highlight = null;
    }
    if (!chosen) return;
    const parts = Object.entries(chosen)
      .filter(([name]) => this.layers.get(name)?.data.lines)
      .map(([name, isChosen]) => ({ lines: this.layers.get(name).data.lines, isChosen }));
    this.highlight = makeHighlight(parts, palette.highlight);
    if (this.highlight) this.scene.add(this.highlight);
  }

  // Makes visible what one pane shows; lines come a little toward the eye, which in this projection
  // does not move them on the screen.
  arrange(view, orbit) {
    for (const [name, surface] of this.surfaces) {
      surface.visible = name === view.surface && view.layers.surface;
      surface.material.uniforms.showsEdges.value = view.layers.edges;
      surface.material.uniforms.showsQuality.value = view.layers.quality;
    }
    const toward = orbit.toward();
    const isInput = view.surface === this.levels.input.name;
    const near = 0.004 * orbit.radius;
    const far = isInput ? near : near + 0.25 * (this.level?.rmin ?? 0);
    const lift = {
      initial: far, adapted: 1.2 * far, dropped: 1.1 * far, conflicts: 2 * far, field: 0.9 * far,
      singularities: 1.5 * far,
    };
    for (const [name, { curves, pickable }] of this.layers) {
      curves.visible = view.layers[name];
      if (widths[name]) curves.material.linewidth = widths[name] * view.lineScale;
      curves.position.copy(toward).multiplyScalar(lift[name]);
      if (!pickable) continue;
      pickable.visible = curves.visible;
      pickable.position.copy(curves.position);
    }
    if (this.highlight) this.highlight.position.copy(toward).multiplyScalar(far);
  }

  // `views`: one or two panes, left to right, on a canvas of width x height CSS pixels.
  draw(context, views, orbit, width, height, ratio) {
    const gl = sharedRenderer();
    gl.setPixelRatio(ratio);
    gl.setSize(width, height, false);
    gl.setClearColor(background);
    gl.setScissorTest(true);
    const dots = this.layers.get("singularities");
    if (dots) setRatio(dots.curves, ratio);
    const part = width / views.length;
    views.forEach((view, i) => {
      gl.setViewport(i * part, 0, part, height);
      gl.setScissor(i * part, 0, part, height);
      this.arrange(view, orbit);
      orbit.update(part, height);
      gl.clear();
      gl.render(this.scene, orbit.camera);
    });
    gl.setScissorTest(false);
    context.drawImage(gl.domElement, 0, 0, context.canvas.width, context.canvas.height);
  }

  // The polyline nearest to (x, y) of a pane that nothing hides: {layer, line}, or null.
  pick(view, orbit, x, y, width, height) {
    const gl = sharedRenderer();
    this.arrange(view, orbit);
    orbit.update(width, height);
    const size = 2 * pickRadius + 1;
    const corner = [Math.round(x) - pickRadius, Math.round(y) - pickRadius];
    orbit.camera.setViewOffset(width, height, ...corner, size, size);
    const surface = this.surfaces.get(view.surface);
    const own = surface?.material;
    if (surface?.visible) {
      surface.material = this.occluder;
      this.pickScene.add(surface);
    }
    gl.setRenderTarget(this.target);
    gl.setClearColor(nothing);
    gl.clear();
    gl.render(this.pickScene, orbit.camera);
    const pixels = new Uint8Array(4 * size * size);
    gl.readRenderTargetPixels(this.target, 0, 0, size, size, pixels);
    gl.setRenderTarget(null);
    orbit.camera.clearViewOffset();
    if (surface) {
      surface.material = own;
      this.scene.add(surface);
    }
    return this.lineOf(nearestNumber(pixels, size));
  }

  lineOf(number) {
    if (number === 0) return null;
    for (const { name, first, count } of this.layers.values())
      if (number >= first && number < first + count)
        return { layer: name, line: number - first };
    return null;
  }
}

function nearestNumber(pixels, size) {
  let best = 0;
  let nearest = Infinity;
  for (let i = 0; i < size * size; ++i) {
    const number = pixels[4 * i] + 256 * pixels[4 * i + 1] + 65536 * pixels[4 * i + 2];
    const distance = Math.hypot((i % size) - pickRadius, Math.floor(i / size) - pickRadius);
    if (number > 0 && distance < nearest) {
      best = number;
      nearest = distance;
    }
  }
  return best;
}

function dispose(object) {
  object.geometry.dispose();
  object.material.dispose();
}
