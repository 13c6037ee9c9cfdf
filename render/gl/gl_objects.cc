// SPDX-License-Identifier: Apache-2.0
// Programs, meshes and framebuffers.
// Tested by tests/render/painter_test.cc
#include "render/gl/gl_objects.h"

#include <array>
#include <cstddef>

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

}  // namespace prehend::render
