precision highp float;
in vec3 viewNormal;
in vec3 corner;
flat in float faceQuality;
out vec4 color;

uniform vec3 surfaceColor;
uniform vec3 classColors[4];
uniform vec4 classLimits;
uniform bool showsQuality;
uniform bool showsEdges;
uniform bool isOfQuads;

vec3 classColor() {
    if (faceQuality < classLimits.x) return classColors[0];
    if (faceQuality < classLimits.y) return classColors[1];
    if (faceQuality < classLimits.z) return classColors[2];
    return classColors[3];
}

// A light beside the eye and a weak one from the left above.
float brightness(vec3 normal) {
    float side = max(dot(normal, normalize(vec3(-0.6, 0.7, 0.4))), 0.0);
    return 0.60 + 0.30 * normal.z + 0.14 * side;
}

void main() {
    vec3 normal = normalize(viewNormal);
    vec3 base = showsQuality ? classColor() : surfaceColor;
    if (!gl_FrontFacing) {
        normal = -normal;
        base *= vec3(0.72, 0.76, 0.84);
    }
    // Colours that mean something stay close to what the legend shows.
    vec3 shaded = base * (showsQuality ? mix(1.0, brightness(normal), 0.5) : brightness(normal));
    if (showsEdges) {
        // Distance to the nearest edge in pixels; where triangles are only a few pixels high their
        // edges fade, or the surface would turn black.
        vec3 slope = fwidth(corner);
        vec3 distances = corner / slope;
        // Opposite the first corner lies the cut through a quad, which is no edge.
        float edge = min(distances.y, distances.z);
        if (!isOfQuads) edge = min(edge, distances.x);
        float height = 1.0 / max(max(slope.x, slope.y), slope.z);
        float line = 1.0 - smoothstep(0.15, 1.05, edge);
        shaded = mix(shaded, vec3(0.16, 0.20, 0.26), line * smoothstep(2.0, 10.0, height) * 0.75);
    }
    color = vec4(shaded, 1.0);
}
