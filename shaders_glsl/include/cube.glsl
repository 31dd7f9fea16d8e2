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
