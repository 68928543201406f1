precision highp float;
in vec3 dotColor;
flat in float corners;
out vec4 color;

uniform bool isPlain;

void main() {
    vec2 place = 2.0 * gl_PointCoord - 1.0;
    if (isPlain) {
        if (dot(place, place) > 1.0) discard;
        color = vec4(dotColor, 1.0);
        return;
    }
    // Distance from the middle over that of the polygon's side in this direction: 1 on the outline.
    float part = 6.2831853 / corners;
    float angle = atan(place.x, -place.y);
    float across = cos(floor(0.5 + angle / part) * part - angle) * length(place);
    float edge = across / cos(0.5 * part);
    if (edge > 0.98) discard;
    color = vec4(edge > 0.74 ? vec3(1.0) : dotColor, 1.0);
}
