// SPDX-License-Identifier: Apache-2.0
// Owners of OpenGL objects: programs, meshes on the GPU, and framebuffers. Their context must be
// current whenever they are used, also on destruction.
// Tested by tests/render/painter_test.cc
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/gl/gl_functions.h"
#include "render/gl/mesh.h"

namespace prehend::render {

class Program {
 public:
  /// Null, with the compiler's message in *error, if the sources do not compile or link.
  static std::unique_ptr<Program> Create(const GlFunctions& gl, const char* vertex_source,
                                         const char* fragment_source, std::string* error);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void Use() const;
  // Setters act on the program in use. Names that the compiler removed are ignored.
  void Set(const char* name, int value) const;
  void SetUnsigned(const char* name, unsigned value) const;
  void Set(const char* name, float value) const;
  void Set(const char* name, const Eigen::Vector2f& value) const;
  void Set(const char* name, const Eigen::Vector3f& value) const;
  void Set(const char* name, const Eigen::Vector4f& value) const;
  void Set(const char* name, const Eigen::Matrix3f& value) const;
  void Set(const char* name, const Eigen::Matrix4f& value) const;

 private:
  Program(const GlFunctions& gl, GLuint name) : gl_(gl), name_(name) {}
  GLint Location(const char* name) const;

  const GlFunctions& gl_;
  GLuint name_;
  mutable std::map<std::string, GLint, std::less<>> locations_;
};

class GpuMesh {
 public:
  GpuMesh(const GlFunctions& gl, const Mesh& mesh);
  ~GpuMesh();
  GpuMesh(const GpuMesh&) = delete;
  GpuMesh& operator=(const GpuMesh&) = delete;

  void Bind() const { gl_.BindVertexArray(vertex_array_); }
  void Draw() const;

 private:
  const GlFunctions& gl_;
  GLuint vertex_array_ = 0;
  GLuint buffers_[2] = {};
  GLsizei index_count_ = 0;
};

/// A framebuffer object with at most one colour and one depth attachment.
class Framebuffer {
 public:
  enum class Color { kNone, kRgba8, kR8, kId };
  enum class Depth { kNone, kRead, kCompare };  ///< to be sampled as values, or as a shadow map
  /// With samples > 0 the buffers are multisampled and can only be blitted. Null if the driver
  /// refuses (size, memory).
  static std::unique_ptr<Framebuffer> Create(const GlFunctions& gl, int width_px, int height_px,
                                             int samples, Color color, Depth depth);
  ~Framebuffer();
  Framebuffer(const Framebuffer&) = delete;
  Framebuffer& operator=(const Framebuffer&) = delete;

  /// Directs drawing to this framebuffer, over its full size.
  void Bind() const;
  /// Copies the buffers in `mask` to a target of the same size and resolves samples.
  void BlitTo(const Framebuffer& target, GLbitfield mask) const;
  void BindColorTexture() const { gl_.BindTexture(GL_TEXTURE_2D, color_texture_); }
  void BindDepthTexture() const { gl_.BindTexture(GL_TEXTURE_2D, depth_texture_); }
  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }

 private:
  Framebuffer(const GlFunctions& gl, int width_px, int height_px);
  void AttachRenderbuffer(GLenum attachment, GLenum format, int samples);
  GLuint AttachTexture(GLenum attachment, GLint internal, GLenum format, GLenum type, GLint filter);

  const GlFunctions& gl_;
  int width_px_, height_px_;
  GLuint name_ = 0;
  GLuint color_texture_ = 0, depth_texture_ = 0;
  std::vector<GLuint> renderbuffers_;
};

}  // namespace prehend::render
