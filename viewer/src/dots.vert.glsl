in vec3 tint;
in float sides;
out vec3 dotColor;
flat out float corners;
uniform float size;

void main() {
    dotColor = tint;
    corners = sides;
    gl_PointSize = size;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
