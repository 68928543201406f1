// A camera without perspective that turns freely around the middle of the model. Both halves of a
// comparison look through the same one, so they are linked by construction.
import { OrthographicCamera, Quaternion, Vector3 } from "three";

const turnPerPixel = 0.008; // radians
const xAxis = new Vector3(1, 0, 0);
const yAxis = new Vector3(0, 1, 0);

export class OrbitCamera {
  // `toward` points from the model to the eye.
  constructor(toward, up, points) {
    this.camera = new OrthographicCamera();
    this.home = homeRotation(new Vector3(...toward), new Vector3(...up));
    this.points = points;
    this.radius = 0;
    for (let i = 0; i < points.length; i += 3)
      this.radius = Math.max(this.radius, Math.hypot(points[i], points[i + 1], points[i + 2]));
    this.reset();
  }

  reset() {
    this.rotation = this.home.clone();
    this.target = new Vector3();
    this.zoom = 1;
    this.fit = this.extent();
    const middle = new Vector3(this.fit.x, this.fit.y, 0).applyQuaternion(this.rotation);
    this.target.copy(middle);
  }

  // What the home view has to show: half sizes and the middle, in the camera's axes.
  extent() {
    const right = xAxis.clone().applyQuaternion(this.rotation);
    const up = yAxis.clone().applyQuaternion(this.rotation);
    const box = [Infinity, -Infinity, Infinity, -Infinity];
    const p = this.points;
    for (let i = 0; i < p.length; i += 3) {
      const x = p[i] * right.x + p[i + 1] * right.y + p[i + 2] * right.z;
      const y = p[i] * up.x + p[i + 1] * up.y + p[i + 2] * up.z;
      box[0] = Math.min(box[0], x);
      box[1] = Math.max(box[1], x);
      box[2] = Math.min(box[2], y);
      box[3] = Math.max(box[3], y);
    }
    return {
      x: (box[0] + box[1]) / 2,
      y: (box[2] + box[3]) / 2,
      width: (box[1] - box[0]) / 2,
      height: (box[3] - box[2]) / 2,
    };
  }

  // For a picture of this many pixels; returns mesh units per pixel.
  update(width, height) {
    const margin = 1.08;
    const half =
      (margin * Math.max(this.fit.height, (this.fit.width * height) / width) || 1) / this.zoom;
    this.unitsPerPixel = (2 * half) / height;
    const { camera } = this;
    camera.top = half;
    camera.bottom = -half;
    camera.right = (half * width) / height;
    camera.left = -camera.right;
    camera.near = 0;
    camera.far = 6 * this.radius;
    camera.quaternion.copy(this.rotation);
    camera.position.copy(this.toward()).multiplyScalar(3 * this.radius).add(this.target);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    return this.unitsPerPixel;
  }

  toward() {
    return new Vector3(0, 0, 1).applyQuaternion(this.rotation);
  }

  turn(dx, dy) {
    const turn = new Quaternion().setFromAxisAngle(yAxis, -dx * turnPerPixel);
    turn.multiply(new Quaternion().setFromAxisAngle(xAxis, -dy * turnPerPixel));
    this.rotation.multiply(turn).normalize();
  }

  roll(angle) {
    this.rotation.multiply(new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), angle));
  }

  shift(dx, dy) {
    const step = new Vector3(-dx, dy, 0).multiplyScalar(this.unitsPerPixel);
    this.target.add(step.applyQuaternion(this.rotation));
  }

  // Keeps the point under (x, y), pixels from the middle, where it is.
  magnify(factor, x = 0, y = 0) {
    const zoom = Math.min(Math.max(this.zoom * factor, 0.2), 500);
    const moved = 1 - this.zoom / zoom;
    this.shift(-x * moved, -y * moved);
    this.zoom = zoom;
  }
}

function homeRotation(toward, up) {
  const camera = new OrthographicCamera();
  camera.up.copy(up);
  camera.position.copy(toward);
  camera.lookAt(0, 0, 0);
  return camera.quaternion.clone();
}
