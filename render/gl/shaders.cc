// SPDX-License-Identifier: Apache-2.0
// Shader sources. Light is computed in linear space, and a soft tone map converts to sRGB.
// Tested by tests/render/painter_test.cc
#include "render/gl/shaders.h"

namespace prehend::render {

// Every pass that draws solids uses this shader, so that depth values are equal to the bit in all
// passes.
const char* const kSolidVertexShader = R"(#version 330 core
layout(location = 0) in vec3 corner;
layout(location = 1) in vec3 direction;
uniform mat4 model, world_to_clip, world_to_light;
uniform mat3 model_normal;
uniform vec3 half_size;
uniform float rounding;
out vec3 p_W, n_W;
out vec4 p_light;
void main() {
  vec4 p = model * vec4(corner * half_size + direction * rounding, 1);
  p_W = p.xyz;
  n_W = model_normal * direction;
  p_light = world_to_light * p;
  gl_Position = world_to_clip * p;
}
)";

// A program for each FINISH (0 solid, 1 ground, 2 region, whose rim is brighter than its middle, 3
// flat colour), with or without SHADOWS: a rasteriser in software runs both sides of every branch.
const char* const kSurfaceFragmentShader = R"(
in vec3 p_W, n_W;
in vec4 p_light;
out vec4 pixel;
uniform vec4 color;  // linear
uniform vec3 to_light, eye;
uniform float gloss, shadow_texel;
uniform vec3 ground;  // centre x and y, radius where it starts to fade
uniform sampler2DShadow shadow_map;

#if SHADOWS
const float kBeside = exp(-1. / .81);  // weight of a neighbour; of one across the corner its square
float Shadow(vec3 n) {
  vec3 q = p_light.xyz / p_light.w * .5 + .5;
  if (q.z > 1. || any(lessThan(q.xy, vec2(0))) || any(greaterThan(q.xy, vec2(1)))) return 1.;
  q.z -= max(.0012 * (1. - dot(n, to_light)), .0003);
  float lit = 0.;
  for (int y = -1; y <= 1; y++)
    for (int x = -1; x <= 1; x++) {
      float weight = (x == 0 ? 1. : kBeside) * (y == 0 ? 1. : kBeside);
      lit += weight * texture(shadow_map, vec3(q.xy + vec2(x, y) * shadow_texel * 1.3, q.z));
    }
  return lit / ((1. + 2. * kBeside) * (1. + 2. * kBeside));
}
#else
float Shadow(vec3 n) { return 1.; }
#endif

float GridLine(float pitch, out vec2 density) {
  vec2 cell = p_W.xy / pitch;
  density = max(fwidth(cell), vec2(1e-5));
  vec2 d = abs(fract(cell - .5) - .5) / density;
  return 1. - min(min(d.x, d.y), 1.);
}

vec3 ToDisplay(vec3 c) {
  c *= 1.02;
  c /= 1. + max(max(c.r, max(c.g, c.b)) - .8, 0.) * .6;
  return pow(clamp(c, 0., 1.), vec3(1. / 2.2));
}

// Powers by products: a rasteriser in software pays for pow() at every pixel.
float Squared(float x) { return x * x; }
float ToThe48th(float x) {
  float to_16 = Squared(Squared(Squared(Squared(x))));
  return to_16 * to_16 * to_16;
}

void main() {
  vec3 albedo = color.rgb;
  float alpha = color.a;
#if FINISH == 3
  pixel = vec4(ToDisplay(albedo), alpha);
#else
  vec3 n = normalize(n_W);
  if (!gl_FrontFacing) n = -n;
  vec3 v = normalize(eye - p_W);
#if FINISH == 2
  float rim = Squared(1. - abs(dot(n, v)));
  pixel = vec4(ToDisplay(albedo * (.75 + .5 * rim)), alpha * (.35 + 2.2 * rim));
#else
#if FINISH == 1
  vec2 fine_density, coarse_density;
  float fine = GridLine(.1, fine_density), coarse = GridLine(.5, coarse_density);
  fine *= 1. - smoothstep(.15, .6, max(fine_density.x, fine_density.y));
  coarse *= 1. - smoothstep(.2, .8, max(coarse_density.x, coarse_density.y));
  albedo *= 1. - .13 * fine - .22 * coarse;
  alpha = 1. - smoothstep(ground.z, ground.z * 2.8, length(p_W.xy - ground.xy));
#endif
  float facing = max(dot(n, to_light), 0.);
  float lit = facing > 0. ? Shadow(n) : 0.;
  vec3 ambient = mix(vec3(.20, .19, .18), vec3(.42, .45, .50), .5 + .5 * n.z);
  float highlight = gloss * ToThe48th(max(dot(n, normalize(to_light + v)), 0.)) * lit;
  float rim = Squared(Squared(1. - max(dot(n, v), 0.))) * .10;
  vec3 c = albedo * (ambient + vec3(1.05, 1., .93) * .85 * facing * lit) + highlight + rim * vec3(.8, .9, 1.);
  pixel = vec4(ToDisplay(c), alpha);
#endif
#endif
}
)";

const char* const kDepthFragmentShader = "#version 330 core\nvoid main() {}\n";

const char* const kIdFragmentShader = R"(#version 330 core
uniform uint object;
out uint pixel;
void main() { pixel = object; }
)";

const char* const kScreenVertexShader = R"(#version 330 core
out vec2 uv;
void main() {
  uv = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
  gl_Position = vec4(uv * 2. - 1., 0, 1);
}
)";

const char* const kBackdropFragmentShader = R"(#version 330 core
in vec2 uv;
out vec4 pixel;
uniform float plain;  // 1: paper
uniform vec3 paper;
void main() {
  vec3 c = mix(vec3(.80, .83, .87), vec3(.95, .965, .98), smoothstep(.3, 1., uv.y));
  pixel = vec4(pow(mix(c, paper, plain), vec3(1. / 2.2)), 1);
}
)";

// Ambient occlusion from the depth buffer: how much of the surroundings within `radius` metres
// rises above the tangent plane, sampled on a spiral that is turned from pixel to pixel
// (interleaved gradient noise, Jimenez 2014).
const char* const kOcclusionFragmentShader = R"(#version 330 core
in vec2 uv;
out vec4 pixel;
uniform sampler2D depth_map;
uniform mat4 clip_to_view;
uniform vec2 texel, view_to_uv;  // view_to_uv: size on screen of one metre at one metre
uniform vec2 depth_size;
uniform float radius;
uniform int taps;
// At the middle of a depth pixel: elsewhere its depth belongs to another place, and grazing floors shadow themselves.
vec3 InView(vec2 wanted) {
  vec2 at = (floor(wanted * depth_size) + .5) / depth_size;
  vec4 p = clip_to_view * vec4(vec3(at, texture(depth_map, at).r) * 2. - 1., 1);
  return p.xyz / p.w;
}
void main() {
  if (texture(depth_map, uv).r >= 1.) { pixel = vec4(1); return; }
  vec3 p = InView(uv);
  vec3 right = InView(uv + vec2(texel.x, 0)) - p, left = p - InView(uv - vec2(texel.x, 0));
  vec3 above = InView(uv + vec2(0, texel.y)) - p, below = p - InView(uv - vec2(0, texel.y));
  vec3 n = normalize(cross(abs(right.z) < abs(left.z) ? right : left, abs(above.z) < abs(below.z) ? above : below));
  float turn = 6.2831853 * fract(52.9829189 * fract(dot(floor(gl_FragCoord.xy), vec2(.06711056, .00583715))));
  float sum = 0.;
  for (int k = 0; k < taps; k++) {
    float angle = turn + float(k) * 2.39996;
    vec2 offset = vec2(cos(angle), sin(angle)) * view_to_uv * radius / -p.z * sqrt((float(k) + .5) / float(taps));
    vec3 d = InView(uv + offset) - p;
    float l = dot(d, d);
    sum += max(dot(d, n) - .004, 0.) / (l + .0004) * (1. - smoothstep(radius * radius * .3, radius * radius, l));
  }
  pixel = vec4(vec3(clamp(1. - sum * radius * 2.1 / float(taps), 0., 1.)), 1);
}
)";

// At half size; bilinear interpolation of means is the mean of interpolations.
const char* const kOcclusionBlurFragmentShader = R"(#version 330 core
in vec2 uv;
out vec4 pixel;
uniform sampler2D occlusion_map;
uniform vec2 texel;
void main() {
  float sum = 0.;
  for (int y = -2; y < 2; y++)
    for (int x = -2; x < 2; x++) sum += texture(occlusion_map, uv + (vec2(x, y) + .5) * texel).r;
  pixel = vec4(vec3(sum / 16.), 1);
}
)";

const char* const kDarkenFragmentShader = R"(#version 330 core
in vec2 uv;
out vec4 pixel;
uniform sampler2D occlusion_map;
void main() { pixel = vec4(vec3(mix(.35, 1., texture(occlusion_map, uv).r)), 1); }
)";

}  // namespace prehend::render
