// SPDX-License-Identifier: Apache-2.0
// Programs, meshes and framebuffers.
#include "render/gl/gl_objects.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "physics/base/check.h"

namespace prehend::render {
namespace {

GLuint CompileShader(const GlFunctions& gl, GLenum type, const char* source, std::string* error) {
  const GLuint shader = gl.CreateShader(type);
  gl.ShaderSource(shader, 1, &source, nullptr);
  gl.CompileShader(shader);
  GLint compiled = GL_FALSE;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  std::array<char, 1024> log = {};
  gl.GetShaderInfoLog(shader, log.size(), nullptr, log.data());
  *error = std::string("a shader does not compile: ") + log.data();
  gl.DeleteShader(shader);
  return 0;
}

// Solids of revolution from a profile and a list of meridians, and tubes by parallel transport.
// Tested by tests/render/gl/mesh_test.cc

using Eigen::Vector3f;
constexpr float kPi = std::numbers::pi_v<float>;

// One ring of a solid of revolution; rings are listed from top to bottom.
struct ProfilePoint {
  float direction_radial, direction_z;
  float corner_radial, corner_z;
};

// One direction around z; a box has several meridians at the same angle with different corners.
struct Meridian {
  float cosine, sine;
  float corner_x, corner_y;
};

Mesh Revolve(const std::vector<ProfilePoint>& profile, const std::vector<Meridian>& meridians) {
  Mesh mesh;
  for (const ProfilePoint& p : profile) {
    for (const Meridian& m : meridians) {
      mesh.vertices.push_back(
          {{p.corner_radial * m.corner_x, p.corner_radial * m.corner_y, p.corner_z},
           {p.direction_radial * m.cosine, p.direction_radial * m.sine, p.direction_z}});
    }
  }
  const auto around = static_cast<std::uint32_t>(meridians.size());
  for (std::uint32_t ring = 0; ring + 1 < profile.size(); ++ring) {
    for (std::uint32_t i = 0; i + 1 < around; ++i) {
      const std::uint32_t upper = ring * around + i, lower = upper + around;
      mesh.triangles.insert(mesh.triangles.end(),
                            {upper, lower, upper + 1, upper + 1, lower, lower + 1});
    }
  }
  return mesh;
}

// Flat top, a quarter arc, the side, a quarter arc, flat bottom.
std::vector<ProfilePoint> RoundedProfile(int segments) {
  std::vector<ProfilePoint> profile = {{0, 1, 0, 1}};
  for (const float side : {1.0f, -1.0f}) {
    for (int i = 0; i <= segments; ++i) {
      const float angle = kPi / 2 * (static_cast<float>(i) / segments + (side > 0 ? 0 : 1));
      profile.push_back({std::sin(angle), std::cos(angle), 1, side});
    }
  }
  profile.push_back({0, -1, 0, -1});
  return profile;
}

// Direction between the first two points that differ.
Vector3f FirstDirection(const std::vector<Vector3f>& points) {
  for (const Vector3f& p : points) {
    const Vector3f chord = p - points.front();
    if (chord.norm() > 1e-9f) return chord.normalized();
  }
  return Vector3f::UnitX();
}

std::vector<Meridian> CircleMeridians(int segments) {
  std::vector<Meridian> meridians;
  for (int i = 0; i <= 4 * segments; ++i) {
    const float angle = kPi / 2 * static_cast<float>(i % (4 * segments)) / segments;
    const float c = std::cos(angle), s = std::sin(angle);
    meridians.push_back({c, s, c, s});
  }
  return meridians;
}

}  // namespace

std::unique_ptr<Program> Program::Create(const GlFunctions& gl, const char* vertex_source,
                                         const char* fragment_source, std::string* error) {
  const GLuint vertex = CompileShader(gl, GL_VERTEX_SHADER, vertex_source, error);
  const GLuint fragment = CompileShader(gl, GL_FRAGMENT_SHADER, fragment_source, error);
  if (vertex == 0 || fragment == 0) return nullptr;
  const GLuint name = gl.CreateProgram();
  gl.AttachShader(name, vertex);
  gl.AttachShader(name, fragment);
  gl.LinkProgram(name);
  gl.DeleteShader(vertex);
  gl.DeleteShader(fragment);
  std::unique_ptr<Program> program(new Program(gl, name));
  GLint linked = GL_FALSE;
  gl.GetProgramiv(name, GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return program;
  std::array<char, 1024> log = {};
  gl.GetProgramInfoLog(name, log.size(), nullptr, log.data());
  *error = std::string("a shader program does not link: ") + log.data();
  return nullptr;
}

Program::~Program() { gl_.DeleteProgram(name_); }

void Program::Use() const { gl_.UseProgram(name_); }

GLint Program::Location(const char* name) const {
  auto found = locations_.find(name);
  if (found == locations_.end()) {
    found = locations_.emplace(name, gl_.GetUniformLocation(name_, name)).first;
  }
  return found->second;
}

void Program::Set(const char* name, int value) const { gl_.Uniform1i(Location(name), value); }
void Program::SetUnsigned(const char* name, unsigned value) const {
  gl_.Uniform1ui(Location(name), value);
}
void Program::Set(const char* name, float value) const { gl_.Uniform1f(Location(name), value); }
void Program::Set(const char* name, const Eigen::Vector2f& value) const {
  gl_.Uniform2fv(Location(name), 1, value.data());
}
void Program::Set(const char* name, const Eigen::Vector3f& value) const {
  gl_.Uniform3fv(Location(name), 1, value.data());
}
void Program::Set(const char* name, const Eigen::Vector4f& value) const {
  gl_.Uniform4fv(Location(name), 1, value.data());
}
void Program::Set(const char* name, const Eigen::Matrix3f& value) const {
  gl_.UniformMatrix3fv(Location(name), 1, GL_FALSE, value.data());
}
void Program::Set(const char* name, const Eigen::Matrix4f& value) const {
  gl_.UniformMatrix4fv(Location(name), 1, GL_FALSE, value.data());
}

GpuMesh::GpuMesh(const GlFunctions& gl, const Mesh& mesh)
    : gl_(gl), index_count_(static_cast<GLsizei>(mesh.triangles.size())) {
  static_assert(sizeof(Vertex) == 6 * sizeof(float));
  gl_.GenVertexArrays(1, &vertex_array_);
  gl_.GenBuffers(2, buffers_);
  gl_.BindVertexArray(vertex_array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(Vertex)),
                 mesh.vertices.data(), GL_STATIC_DRAW);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[1]);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(std::uint32_t)),
                 mesh.triangles.data(), GL_STATIC_DRAW);
  const std::size_t offsets[] = {offsetof(Vertex, corner), offsetof(Vertex, direction)};
  for (GLuint i = 0; i < 2; ++i) {
    gl_.EnableVertexAttribArray(i);
    gl_.VertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                            reinterpret_cast<const void*>(offsets[i]));
  }
}

GpuMesh::~GpuMesh() {
  gl_.DeleteVertexArrays(1, &vertex_array_);
  gl_.DeleteBuffers(2, buffers_);
}

void GpuMesh::Draw() const {
  Bind();
  gl_.DrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

Framebuffer::Framebuffer(const GlFunctions& gl, int width_px, int height_px)
    : gl_(gl), width_px_(width_px), height_px_(height_px) {
  gl_.GenFramebuffers(1, &name_);
}

std::unique_ptr<Framebuffer> Framebuffer::Create(const GlFunctions& gl, int width_px, int height_px,
                                                 int samples, Color color, Depth depth) {
  std::unique_ptr<Framebuffer> made(new Framebuffer(gl, width_px, height_px));
  gl.BindFramebuffer(GL_FRAMEBUFFER, made->name_);
  if (color == Color::kNone) {
    gl.DrawBuffer(GL_NONE);
    gl.ReadBuffer(GL_NONE);
  } else if (color == Color::kId) {
    made->AttachRenderbuffer(GL_COLOR_ATTACHMENT0, GL_R32UI, 0);
  } else if (samples > 0) {
    made->AttachRenderbuffer(GL_COLOR_ATTACHMENT0, GL_RGBA8, samples);
  } else {
    const bool gray = color == Color::kR8;
    made->color_texture_ =
        made->AttachTexture(GL_COLOR_ATTACHMENT0, gray ? GL_R8 : GL_RGBA8, gray ? GL_RED : GL_RGBA,
                            GL_UNSIGNED_BYTE, GL_LINEAR);
  }
  if (depth != Depth::kNone && (samples > 0 || color == Color::kId)) {
    made->AttachRenderbuffer(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, samples);
  } else if (depth != Depth::kNone) {
    made->depth_texture_ =
        made->AttachTexture(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT,
                            GL_UNSIGNED_INT, depth == Depth::kCompare ? GL_LINEAR : GL_NEAREST);
    if (depth == Depth::kCompare) {
      gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
      gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    }
  }
  const bool complete = gl.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  return complete ? std::move(made) : nullptr;
}

Framebuffer::~Framebuffer() {
  gl_.DeleteFramebuffers(1, &name_);
  gl_.DeleteTextures(1, &color_texture_);
  gl_.DeleteTextures(1, &depth_texture_);
  gl_.DeleteRenderbuffers(static_cast<GLsizei>(renderbuffers_.size()), renderbuffers_.data());
}

void Framebuffer::AttachRenderbuffer(GLenum attachment, GLenum format, int samples) {
  GLuint buffer = 0;
  gl_.GenRenderbuffers(1, &buffer);
  renderbuffers_.push_back(buffer);
  gl_.BindRenderbuffer(GL_RENDERBUFFER, buffer);
  gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width_px_, height_px_);
  gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
}

GLuint Framebuffer::AttachTexture(GLenum attachment, GLint internal, GLenum format, GLenum type,
                                  GLint filter) {
  GLuint texture = 0;
  gl_.GenTextures(1, &texture);
  gl_.BindTexture(GL_TEXTURE_2D, texture);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, internal, width_px_, height_px_, 0, format, type, nullptr);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
  return texture;
}

void Framebuffer::Bind() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, name_);
  gl_.Viewport(0, 0, width_px_, height_px_);
}

void Framebuffer::BlitTo(const Framebuffer& target, GLbitfield mask) const {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, name_);
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, target.name_);
  gl_.BlitFramebuffer(0, 0, width_px_, height_px_, 0, 0, width_px_, height_px_, mask, GL_NEAREST);
}

Mesh RoundedBoxMesh(int segments) {
  std::vector<Meridian> meridians;
  constexpr float kCornerX[] = {1, -1, -1, 1}, kCornerY[] = {1, 1, -1, -1};
  for (int quadrant = 0; quadrant < 4; ++quadrant) {
    for (int i = 0; i <= segments; ++i) {
      const float angle = kPi / 2 * (quadrant + static_cast<float>(i) / segments);
      meridians.push_back(
          {std::cos(angle), std::sin(angle), kCornerX[quadrant], kCornerY[quadrant]});
    }
  }
  meridians.push_back(meridians.front());
  return Revolve(RoundedProfile(segments), meridians);
}

Mesh RoundedCylinderMesh(int segments) {
  return Revolve(RoundedProfile(segments), CircleMeridians(2 * segments));
}

Mesh ConeMesh(int segments) {
  constexpr float kSlope = 0.4f;  // the normal's z for the flattest cone that is drawn
  const float radial = std::sqrt(1 - kSlope * kSlope);
  return Revolve({{radial, kSlope, 0, 1}, {radial, kSlope, 1, 0}, {0, -1, 1, 0}, {0, -1, 0, 0}},
                 CircleMeridians(segments));
}

Mesh HullMesh(const physics::Hull& hull) {
  Mesh mesh;
  for (const physics::Hull::Face& face : hull.faces) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const int corner : face.corners) {
      PREHEND_DCHECK(corner >= 0 && corner < std::ssize(hull.corners_m));
      mesh.vertices.push_back({hull.corners_m[static_cast<std::size_t>(corner)].cast<float>(),
                               face.nhat_S.cast<float>()});
    }
    for (std::uint32_t i = 2; i < face.corners.size(); ++i)
      mesh.triangles.insert(mesh.triangles.end(), {first, first + i - 1, first + i});
  }
  return mesh;
}

Mesh TubeMesh(const std::vector<Vector3f>& points, int segments) {
  Mesh mesh;
  if (points.size() < 2) return mesh;
  Vector3f tangent = FirstDirection(points);
  Vector3f across = tangent.unitOrthogonal();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3f chord = points[std::min(i + 1, points.size() - 1)] - points[i == 0 ? 0 : i - 1];
    const Vector3f next = chord.norm() > 1e-9f ? Vector3f(chord.normalized()) : tangent;
    // Rotating the frame with the tangent prevents twist of the tube.
    across = (RotationBetween(tangent, next) * across).normalized();
    tangent = next;
    const Vector3f up = tangent.cross(across);
    for (int k = 0; k <= segments; ++k) {
      const float angle = 2 * kPi * static_cast<float>(k % segments) / segments;
      mesh.vertices.push_back({points[i], std::cos(angle) * across + std::sin(angle) * up});
    }
  }
  const auto around = static_cast<std::uint32_t>(segments + 1);
  for (std::uint32_t ring = 0; ring + 1 < points.size(); ++ring) {
    for (std::uint32_t k = 0; k + 1 < around; ++k) {
      const std::uint32_t here = ring * around + k, ahead = here + around;
      mesh.triangles.insert(mesh.triangles.end(),
                            {here, here + 1, ahead, here + 1, ahead + 1, ahead});
    }
  }
  return mesh;
}

Eigen::Quaternionf RotationBetween(const Vector3f& from, const Vector3f& to) {
  return Eigen::Quaternionf::FromTwoVectors(from, to);
}

// Shader sources. Light is computed in linear space, and a soft tone map converts to sRGB.

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
