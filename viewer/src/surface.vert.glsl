in float quality;
out vec3 viewNormal;
out vec3 corner;
flat out float faceQuality;

void main() {
    viewNormal = normalMatrix * normal;
    // Triangles have corners of their own, so the number of a corner tells its place in them.
    int place = gl_VertexID % 3;
    corner = vec3(place == 0, place == 1, place == 2);
    faceQuality = quality;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
