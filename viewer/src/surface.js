import { DoubleSide, GLSL3, Mesh, ShaderMaterial, Vector3, Vector4 } from "three";
import { angleClasses, palette, rgb } from "./palette.js";
import { surfaceGeometry } from "./surface_geometry.js";
import fragmentShader from "./surface.frag.glsl";
import vertexShader from "./surface.vert.glsl";

export function makeSurface(points, corners) {
  const material = new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader,
    fragmentShader,
    side: DoubleSide,
    uniforms: {
      surfaceColor: { value: new Vector3(...rgb(palette.surface)) },
      classColors: { value: angleClasses.map((c) => new Vector3(...rgb(c.color))) },
      classLimits: { value: new Vector4(...angleClasses.map((c) => c.under)) },
      showsQuality: { value: false },
      showsEdges: { value: false },
    },
  });
  const mesh = new Mesh(surfaceGeometry(points, corners), material);
  mesh.frustumCulled = false;
  return mesh;
}
