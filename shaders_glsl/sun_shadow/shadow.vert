#version 460
#extension GL_EXT_scalar_block_layout : require

layout(location = 0) in vec3 position; // world, metres

layout(push_constant, scalar) uniform Push {
    mat4 shadow_from_world;
} push;

void main() {
    gl_Position = push.shadow_from_world * vec4(position, 1.0);
}
