// Irregular vertices as marks that keep their size: polygons with as many corners as quads meet there,
// so that colour is not all that tells them apart; for picking, once more in colours that are numbers.
import {
  BufferAttribute, BufferGeometry, GLSL3, Points, ShaderMaterial, Sphere, Vector3,
} from "three";
import fragmentShader from "./dots.frag.glsl";
import vertexShader from "./dots.vert.glsl";
import { rgb, singularColor } from "./palette.js";

const markSize = 15; // pixels
const pickingSize = 17;

function makePoints({ points, valence }, size, colors, isPlain) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(points, 3));
  geometry.setAttribute("tint", new BufferAttribute(colors, 3));
  const sides = Float32Array.from(valence, (count) => Math.min(8, Math.max(3, count)));
  geometry.setAttribute("sides", new BufferAttribute(sides, 1));
  geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
  const material = new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader,
    fragmentShader,
    uniforms: { size: { value: size }, isPlain: { value: isPlain } },
  });
  const object = new Points(geometry, material);
  object.frustumCulled = false;
  return object;
}

export function makeDots(data) {
  const colors = new Float32Array(data.points.length);
  data.valence.forEach((count, i) => colors.set(rgb(singularColor(count)), 3 * i));
  return makePoints(data, markSize, colors, false);
}

// Mark k in the colour of the number `first` + k.
export function makePickableDots(data, first) {
  const colors = new Float32Array(data.points.length);
  data.valence.forEach((_, i) => {
    const number = first + i;
    for (let k = 0; k < 3; ++k) colors[3 * i + k] = ((number >> (8 * k)) & 255) / 255;
  });
  return makePoints(data, pickingSize, colors, true);
}

// In device pixels where the picture has `ratio` of them to one.
export function setRatio(dots, ratio) {
  dots.material.uniforms.size.value = markSize * ratio;
}
