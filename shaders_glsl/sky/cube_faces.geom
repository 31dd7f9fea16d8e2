#version 460

// Layered rendering, as on the lecture's slide "Irradiance environment map": the triangle is emitted once per cube face, selected
// by gl_Layer.
layout(triangles) in;
layout(triangle_strip, max_vertices = 18) out;

layout(location = 0) out vec2 face_st;
layout(location = 1) flat out int face;

void main() {
    for (int layer = 0; layer < 6; ++layer) {
        for (int corner = 0; corner < 3; ++corner) {
            gl_Layer = layer;
            gl_Position = gl_in[corner].gl_Position;
            face_st = gl_in[corner].gl_Position.xy * 0.5 + 0.5;
            face = layer;
            EmitVertex();
        }
        EndPrimitive();
    }
}
