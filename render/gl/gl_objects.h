// SPDX-License-Identifier: Apache-2.0
// Owners of OpenGL objects: programs, meshes on the GPU, and framebuffers. Their context must be
// current whenever they are used, also on destruction. Tested by tests/render/painter_test.cc
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "physics/scene/scene.h"
#include "render/gl/gl_functions.h"

namespace prehend::render {

// Triangle meshes. A vertex is a corner and an outward direction; a mesh is drawn as
//   position = corner * half_size + direction * rounding
// (the Minkowski sum of a solid and a ball), so one unit mesh gives every rounded box, ball,
// capsule or cylinder without distorted bevels. Tested by tests/render/gl/mesh_test.cc

struct Vertex {
  Eigen::Vector3f corner;
  Eigen::Vector3f direction;  ///< unit
};

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> triangles;  ///< three indices each, counter-clockwise from outside
};

/// Corners at +-1; `segments` per quarter turn of an edge. Half size 0 gives a ball, (0, 0, h) a
/// capsule.
Mesh RoundedBoxMesh(int segments);
/// Unit radius and half length around z, with rounded rims.
Mesh RoundedCylinderMesh(int segments);
/// Base of unit radius at z = 0, tip at z = 1.
Mesh ConeMesh(int segments);
/// Flat faces; corners are the hull's own: draw it with half size 1.
Mesh HullMesh(const physics::Hull& hull);
/// A tube along the points; corners are the points themselves: draw it with half size 1. Empty for
/// fewer than two points.
Mesh TubeMesh(const std::vector<Eigen::Vector3f>& points, int segments);

/// The shortest rotation from one direction to another, as physics::RotationBetween.
Eigen::Quaternionf RotationBetween(const Eigen::Vector3f& from, const Eigen::Vector3f& to);

// The shader sources (GLSL 3.30). render/gl/gl_objects.cc describes what each computes.

/// Version of the pixels: raise it whenever they change on purpose. Part of the fingerprint.
inline constexpr int kRendererVersion = 3;

extern const char* const
    kSolidVertexShader;  ///< corner * half_size + direction * rounding, to world and clip
extern const char* const kSurfaceFragmentShader;  ///< light, shadow, ground grid, region rim; needs
                                                  ///< #version, FINISH and SHADOWS before it
extern const char* const kDepthFragmentShader;    ///< depth only
extern const char* const kIdFragmentShader;       ///< the object's number
extern const char* const kScreenVertexShader;     ///< one triangle over the whole target
extern const char* const kBackdropFragmentShader;
extern const char* const kOcclusionFragmentShader;
extern const char* const kOcclusionBlurFragmentShader;
extern const char* const kDarkenFragmentShader;  ///< factor by which corners darken

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
