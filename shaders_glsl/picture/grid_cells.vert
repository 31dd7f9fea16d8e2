#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Cells of a grid of sensors: two triangles each.

struct Cell {
    vec3 corners[4]; // in world space, around
    vec3 colour;     // display light, linear
};

layout(set = 0, binding = 0, scalar) readonly buffer Cells {
    Cell cells[];
} table;

layout(push_constant, scalar) uniform Push {
    mat4 clip_from_world;
} push;

layout(location = 0) flat out vec3 colour;

void main() {
    Cell cell = table.cells[gl_VertexIndex / 6];
    int k = gl_VertexIndex % 6;
    int corner = k == 3 ? 0 : k == 4 ? 2 : k == 5 ? 3 : k;
    colour = cell.colour;
    gl_Position = push.clip_from_world * vec4(cell.corners[corner], 1.0);
}
