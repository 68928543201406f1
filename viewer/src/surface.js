import { DoubleSide, GLSL3, Mesh, ShaderMaterial, Vector3, Vector4 } from "three";
import { angleClasses, jacobianClasses, palette, rgb } from "./palette.js";
import { cutQuads, scaledJacobians } from "./quads.js";
import { smallestAngles } from "./surface_angles.js";
import { surfaceGeometry } from "./surface_geometry.js";
import fragmentShader from "./surface.frag.glsl";
import vertexShader from "./surface.vert.glsl";

// Of triangles, or of quads where a face has four `sides`.
export function makeSurface({ points, corners, sides }) {
  const isOfQuads = sides === 4;
  const classes = isOfQuads ? jacobianClasses : angleClasses;
  const material = new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader,
    fragmentShader,
    side: DoubleSide,
    uniforms: {
      surfaceColor: { value: new Vector3(...rgb(palette.surface)) },
      classColors: { value: classes.map((c) => new Vector3(...rgb(c.color))) },
      classLimits: { value: new Vector4(...classes.map((c) => c.under)) },
      showsQuality: { value: false },
      showsEdges: { value: false },
      isOfQuads: { value: isOfQuads },
    },
  });
  const geometry = isOfQuads
    ? surfaceGeometry(points, cutQuads(corners), () => sixfold(scaledJacobians(points, corners)))
    : surfaceGeometry(points, corners, smallestAngles);
  const mesh = new Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}

// Each value for the corners of both of a quad's triangles.
function sixfold(values) {
  const result = new Float32Array(6 * values.length);
  values.forEach((value, i) => result.fill(value, 6 * i, 6 * i + 6));
  return result;
}
