#ifndef CUBE_GLSL
#define CUBE_GLSL
// Cube map faces in Vulkan's order and orientation: +X -X +Y -Y +Z -Z (Vulkan specification, "Cube Map Face Selection").

/// Direction (not normalized) through the point st in [0,1]^2 of a face.
vec3 cube_direction(int face, vec2 st) {
    vec2 c = st * 2.0 - 1.0;
    switch (face) {
        case 0: return vec3(1.0, -c.y, -c.x);
        case 1: return vec3(-1.0, -c.y, c.x);
        case 2: return vec3(c.x, 1.0, c.y);
        case 3: return vec3(c.x, -1.0, -c.y);
        case 4: return vec3(c.x, -c.y, 1.0);
        default: return vec3(-c.x, -c.y, -1.0);
    }
}

/// The face that a direction meets, and the point st in [0,1]^2 on it.
int cube_face(vec3 d, out vec2 st) {
    vec3 a = abs(d);
    vec3 c; // coordinates on the face, and the length along its axis
    int face;
    if (a.z >= a.x && a.z >= a.y) {
        c = vec3(d.z < 0.0 ? -d.x : d.x, -d.y, a.z);
        face = d.z < 0.0 ? 5 : 4;
    } else if (a.y >= a.x) {
        c = vec3(d.x, d.y < 0.0 ? -d.z : d.z, a.y);
        face = d.y < 0.0 ? 3 : 2;
    } else {
        c = vec3(d.x < 0.0 ? d.z : -d.z, -d.y, a.x);
        face = d.x < 0.0 ? 1 : 0;
    }
    st = c.xy / c.z * 0.5 + 0.5;
    return face;
}
#endif
