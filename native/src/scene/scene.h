// The scene: meshes, materials, instances, lights, environment and camera, in plain arrays.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>
#include "base/progress.h"
#include "base/warning.h"
#include "light/environment.h"
#include "light/light.h"
#include "material/texture.h"
#include "scene/camera.h"
#include "scene/embree_scene.h"
#include "scene/mesh.h"
#include "scene/motion.h"
#include "scene/scene_shells.h"
#include "scene/world_program.h"
#include "votf/eval/occlusion_volume.h"

namespace velour {

// Cache for data derived from a state of a scene, kept with that scene.

/// One object, of one type, for one revision of a scene. Thread-safe.
class SceneKeep {
 public:
  /// The T of `revision`, default-constructed at the first call. Holders of a T of another revision keep theirs.
  template <typename T>
  std::shared_ptr<T> of(uint64_t revision) {
    const std::lock_guard lock(mutex_);
    if (!kept_ || type_ != &typeid(T) || revision_ != revision) {
      kept_ = std::make_shared<T>();
      type_ = &typeid(T);
      revision_ = revision;
    }
    return std::static_pointer_cast<T>(kept_);
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<void> kept_;
  const std::type_info* type_ = nullptr;
  uint64_t revision_ = 0;
};

class Material;
class Program;

/// The material of a material slot, and how it is shown.
struct SurfaceMaterial {
  std::shared_ptr<const Material> material;
  Rgb emission{0.0f};         // radiance of both sides, working space
  bool rec709_colors = true;  // f is Rec. 709 (measured) and is converted to the working space; false: already there
  bool relief = false;        // has a normal map: its meshes need tangents
  bool brushed = false;       // uniform and anisotropic: +x is smooth_tangent(), its meshes need tangents
  uint8_t uv_sets = 1;        // number of texture coordinate sets in use, at most SurfaceSite::kMaxSets
  uint8_t color_sets = 0;     // number of corner color sets in use, at most SurfaceSite::kMaxColorSets
  /// Computes SurfaceSite::computed; null: the material uses none of it. `opacity`: the part of it that alpha() and
  /// passing() depend on; null: none.
  std::shared_ptr<const Program> program = nullptr, opacity = nullptr;
  /// Structure over the surface that rays can pass through; null: none. Needs texture coordinates.
  std::shared_ptr<const ShellField> shell = nullptr;
  /// True: the structure's own surface is shaded and shadowed. False: f describes the appearance of the structure over
  /// its base plane, as a BTF does.
  bool shell_shaded = false;
  /// Whether f is a BTF whose values are averaged over the holes of its structure, which rays find for themselves.
  bool holed() const { return shell && !shell_shaded && !shell->volume().closed; }
  /// Width of a tile in meters, which scales the shell's height; 0: derived from the texture coordinates.
  float shell_tile = 0;
  /// Width over which the structure's edge fades out, in tile widths (ShellEdge); 0: hard.
  float shell_softness = 0;
  /// Whether emissive meshes with it are light-sampled; false: only BSDF sampling finds their light.
  bool drawn_to = true;
  /// Kinds of rays (bits of `hidden`) that pass through back faces, the side opposite to the mesh's normal. Shells have
  /// no back faces.
  uint8_t hidden_backs = 0;
  bool hides_backs() const { return hidden_backs != 0 && !shell; }
  /// Factor on f in the working space: an artist's tint and exposure. Does not affect sampling densities.
  Rgb gain{1.0f};
  /// Takes the place of `material` where a view is mirrored below the faces of a smooth mesh: with corrected normals.
  /// Null: none.
  std::shared_ptr<const Material> turned{};
};

/// Kinds of rays that instances can be hidden from: bits of Instance::hidden and RayKinds, values of velour.h.
namespace hidden {
/// Bounces: reflected rays. Transmission: rays that surfaces have transmitted.
inline constexpr uint8_t kFromCamera = 1, kFromBounces = 2, kFromShadows = 4, kFromTransmission = 16;
/// Not a kind of ray: the camera sees neither the instance nor anything behind it.
inline constexpr uint8_t kHoldout = 8;
}  // namespace hidden

/// Geometry of a hit for shading, in world space.
struct SurfacePoint {
  Vec3 position;
  Vec3 geometric_normal;  // unit, towards the mesh's front
  Vec3 shading_normal;    // unit, interpolated, towards the mesh's front
  Vec3 tangent;           // along the placed first texture coordinate, not normalized; zero if there is none
  float error;            // bound of |position - exact|, per coordinate
  uint32_t material;
  /// Vector from `position` to the smooth surface that the shading normals imply, on the mesh's front; zero unless the
  /// instance softens its shadow terminator.
  Vec3 rounding{0.0f};
  float terminator = 0;  // cosine below which shadow rays begin on that surface; 0: nowhere
};

/// Placed texture coordinates of a hit, for materials that vary over the surface. (0, 0) without gradients if the mesh
/// has no texture coordinates or they are not finite.
struct TexturePoint {
  Vec2 uv{0.0f};
  /// d uv / d position on the triangle's plane in world space, for any transform of the instance; zero if the triangle
  /// is too small for float64.
  Vec3 u_gradient{0.0f}, v_gradient{0.0f};
};

struct SceneInfo {
  uint64_t triangles = 0;  // over all instances
  uint64_t instances = 0, meshes = 0, lights = 0, materials = 0;
  uint64_t bytes = 0;  // hierarchy, meshes, environment
  double bvh_seconds = 0;
  std::vector<Warning> warnings;  // no_light concerns rendered scenes only, not those that are traced
};

/// Local geometry of a shell at a hit, in world space.
struct ShellFrame {
  const ShellField* field;
  float softness;  // of its edge, in tile widths
  Vec3 normal;     // unit, interpolated, towards the mesh's front
  float scale;     // tile widths per meter along the normal
  Vec2 uv;         // texture coordinates, as placed
  // Along the requested direction:
  float curvature = 0;     // normal curvature, 1 / meters
  Vec3 normal_turn{0.0f};  // derivative of the normal, 1 / meters
  Vec2 uv_along{0.0f};     // derivative of the texture coordinates, 1 / meters
};

/// Fill, commit, render. Every change after commit() needs another commit(), which rebuilds only what has changed.
/// Reading a committed scene is thread-safe.
class Scene {
 public:
  /// add_mesh(), add_material() and add_light() return the number of the new object, counted from 0. Arguments that
  /// name missing objects throw Error(invalid_argument).
  uint32_t add_mesh(Mesh mesh);
  /// Frees a mesh that no instance shows. Its number stays valid and names a mesh without triangles.
  void remove_mesh(uint32_t number);
  uint32_t add_material(SurfaceMaterial material);
  /// Replaces a material. A committed scene stays committed unless the shells of the two differ in presence, heights or
  /// aspect, or only the new material needs tangents. Nothing may read the scene meanwhile. Gain and hidden backs are
  /// kept, as are the shell's tile and softness if both have a shell.
  void set_material(uint32_t number, SurfaceMaterial material);
  /// Moves the last material into slot `number` (swap and pop).
  void replace_material(uint32_t number);
  /// SurfaceMaterial::shell_tile. Throws Error(invalid_argument) for a material without a shell.
  void set_shell_tile(uint32_t material, float metres);
  /// SurfaceMaterial::shell_softness, at least 0 and below 1. Throws like set_shell_tile(). A committed scene stays
  /// committed.
  void set_shell_softness(uint32_t material, float widths);
  /// SurfaceMaterial::gain, finite and at least 0. A committed scene stays committed.
  void set_gain(uint32_t material, const Rgb& gain);
  /// SurfaceMaterial::hidden_backs. A committed scene stays committed.
  void set_hidden_backs(uint32_t material, uint8_t from);
  /// SurfaceMaterial::drawn_to. A committed scene stays committed.
  void set_drawn_to(uint32_t material, bool drawn);
  /// `materials[s]` is the material of slot s of the mesh; slots beyond the list use its last entry. An instance
  /// without volume (a zero scale) is left out and counted in the warnings. `placements[s]` transforms the texture
  /// coordinates of slot s, and with them its footprints and tangents; none: identity. `hidden_from`: bits of `hidden`.
  /// `terminator`: cosine, 0 to 1, below which shadow rays begin on the smooth surface that the mesh approximates
  /// (Vertex::shadow_ray); 0: always on the mesh.
  void add_instance(uint32_t mesh, const Affine& object_to_world, std::vector<uint32_t> materials,
                    std::vector<TextureMap> placements = {}, uint8_t hidden_from = 0, float terminator = 0) {
    add_moving_instance(mesh, {&object_to_world, 1}, std::move(materials), std::move(placements), hidden_from,
                        terminator);
  }
  /// An instance with its transforms at even times while the shutter is open, from 0 to 1 (motion_steps()); one: it
  /// stays. Whatever does not depend on time, such as the heights of shells, is that of the middle.
  void add_moving_instance(uint32_t mesh, std::span<const Affine> object_to_world, std::vector<uint32_t> materials,
                           std::vector<TextureMap> placements = {}, uint8_t hidden_from = 0, float terminator = 0);
  void clear_instances();
  uint32_t add_light(const Light& light);
  void clear_lights();
  void set_environment(Environment environment);
  /// Kinds of rays, bits of `hidden` (bounces, transmission), that the environment does not light; 0: none.
  void hide_environment(uint8_t from);
  /// Sets the environment to WorldProgram::baked(). Camera rays that leave the scene see the program itself.
  void set_world(WorldProgram world, int width, int height);
  void set_camera(const Camera& camera);
  /// Sets the camera to Camera::framing() of all instances.
  void frame_camera(float aspect, int up_axis);
  /// Sets the conversion from Rec. 709 to the color space of all other colors of the scene and of the film.
  void set_working_space(const Mat3& rec709_to_working);

  /// Checks the scene and builds the hierarchy with at most `threads` threads (0: all). Does nothing if the scene is
  /// committed. Throws Error(cancelled) soon after `progress` is canceled; another commit() resumes the build.
  void commit(int threads = 0, const Progress* progress = nullptr);
  /// Declares, before the first commit(), that the geometry will not change after it, which speeds up rays
  /// (EmbreeScene::Levels). If it does change, it is rebuilt. Hits differ in the last bits from those of a scene that
  /// may change.
  void stay() { stays_ = true; }
  bool committed() const { return committed_; }
  /// Changes with every change of the scene, except of the camera.
  uint64_t revision() const { return revision_; }
  /// The T shared by all callers until the revision changes, so that data derived from the scene are computed once.
  template <typename T>
  std::shared_ptr<T> kept() const {
    return keep_->of<T>(revision_);
  }

  struct Instance {
    uint32_t mesh;
    Affine object_to_world;  // in the middle, as the next
    Mat3 normal_to_world;
    std::vector<uint32_t> materials;
    std::vector<TextureMap> placements;  // one per material, or none
    uint8_t hidden;
    float terminator = 0;  // see SurfacePoint
    /// Set by commit(). `top`: what rays hit in place of the mesh if a material has a shell; `traced`: number of the
    /// mesh or the top in the hierarchy; `tile_width`: width of a tile of each slot's shell, in meters.
    const ShellTop* top = nullptr;
    uint32_t traced = kNoHit;
    std::vector<float> tile_width = {};
    uint32_t sides = kNoHit;         // number of the instance of the shell's sides alone; kNoHit: none
    std::vector<Affine> steps = {};  // if it moves: motion_steps()

    bool moves() const { return !steps.empty(); }
    /// Kinds of rays that do not meet it.
    uint8_t hidden_from() const { return hidden & static_cast<uint8_t>(~hidden::kHoldout); }
    Affine place(float time) const { return moves() ? interpolated(steps, time) : object_to_world; }
    Mat3 normal_map(float time) const { return moves() ? interpolated(steps, time).normal_map() : normal_to_world; }
    /// Encloses everything in `box` at all times.
    Bounds box_in_world(const Bounds& box) const;
  };
  const std::vector<Mesh>& meshes() const { return meshes_; }
  /// Indexed by Hit::instance.
  const std::vector<Instance>& instances() const { return instances_; }

  /// The mesh that rays() holds for an instance: its own, or the top of its shell with the sides.
  const Mesh& traced_mesh(const Instance& i) const { return i.top != nullptr ? i.top->mesh : meshes_[i.mesh]; }

  const EmbreeScene& rays() const { return *rays_; }
  /// Steps that rays() has of an instance: none unless the shutter is open for a time, so that a scene of which only
  /// the pass "Vector" shows the motion has the same hits as one without motion.
  std::span<const Affine> traced_steps(const Instance& i) const {
    return camera_.shutter ? std::span<const Affine>(i.steps) : std::span<const Affine>();
  }
  SurfacePoint surface(const Hit& hit) const;
  /// Number of the material at a hit.
  uint32_t material(const Hit& hit) const;
  bool is_holdout(const Hit& hit) const { return (instances_[hit.instance].hidden & hidden::kHoldout) != 0; }
  /// Separate from surface(), because most materials are uniform. Only the first set of texture coordinates is placed.
  TexturePoint texture(const Hit& hit, size_t set = 0) const;
  /// Mesh::color at a hit.
  Rgb color(const Hit& hit, size_t set) const {
    return traced_mesh(instances_[hit.instance]).color(hit.triangle, {hit.u, hit.v}, set);
  }
  /// Position of a hit in object space.
  Vec3 object_position(const Hit& hit) const {
    return traced_mesh(instances_[hit.instance]).position(hit.triangle, {hit.u, hit.v}, hit.time);
  }
  /// World-space position that the point of the surface has at another time.
  Vec3 position(const Hit& hit, float time) const {
    const Instance& i = instances_[hit.instance];
    return i.place(time).point(traced_mesh(i).position(hit.triangle, {hit.u, hit.v}, time));
  }
  /// Derivatives of Hit::u and Hit::v along world-space `offset`, projected onto the triangle; 0 on one without an
  /// area.
  Vec2 barycentric_step(const Hit& hit, const Vec3& offset) const;
  /// Axes of a normal map at a hit in world space: tangent, bitangent, and normal towards the mesh's front, not
  /// normalized. Zero without texture coordinates, or if no material of the mesh needs tangents.
  Mat3 relief(const Hit& hit) const;
  /// Whether a hit is on the top or a side of a shell.
  bool has_shell(const Hit& hit) const {
    const Instance& instance = instances_[hit.instance];
    return !instance.tile_width.empty() && instance.tile_width[slot(hit)] > 0;
  }
  /// Point on the top for a hit on a shell: the hit itself or, for a hit on a side, the border point above it.
  struct ShellFoot {
    Hit top;
    bool is_side = false;
    float below = 0;  // distance of the hit below the top, as a fraction of the shell's height
  };
  ShellFoot shell_foot(const Hit& hit) const;
  /// Whether the shell has sides, which is where it ends.
  bool has_sides(const Hit& hit) const { return instances_[hit.instance].sides != kNoHit; }
  /// Distance along the ray to the first side of the hit shell that leads into it (`inwards`) or out of it; infinite if
  /// there is none.
  float next_side(const Hit& hit, const Ray& ray, bool inwards) const;
  /// The same for the surface of the shell's instance, past `ray.near`.
  float next_top(const Hit& hit, const Ray& ray, bool inwards) const;
  /// ShellFrame of a hit on the top, with derivatives along the tangential part of unit `direction`.
  ShellFrame shell(const Hit& hit, const Vec3& direction) const;

  const Camera& camera() const { return camera_; }
  const Environment& environment() const { return environment_; }
  uint8_t environment_hidden() const { return environment_hidden_; }
  /// Radiance of camera rays that leave the scene, in each direction of `world`, a padded batch.
  void look_up_background(const DirectionBatch& world, RgbBatch& radiance) const;
  const std::vector<Light>& lights() const { return lights_; }
  const std::vector<SurfaceMaterial>& materials() const { return materials_; }
  /// Empty if the working space is Rec. 709.
  const std::optional<Mat3>& rec709_to_working() const { return rec709_to_working_; }
  /// Bounds of all instances, as committed.
  const Bounds& bounds() const { return bounds_; }
  const SceneInfo& info() const { return info_; }

 private:
  void changed();           // the geometry stays
  void geometry_changed();  // a mesh, an instance or a shell has changed
  void build_rays(int threads, const Progress* progress);
  /// Adds a mesh or a top to the hierarchy, or removes it. `number`: its number there, kNoHit if it is not there.
  void trace(const Mesh& mesh, bool is_traced, uint32_t& number);
  void drop_tops(uint32_t mesh);
  SurfaceMaterial& with_shell(uint32_t material, const char* to_what);
  void make_tangents();
  void lift_shells(const Progress* progress);
  void lift(Instance& instance);
  void build_sides(int threads);
  ShellFolds folds(const Instance& instance, uint32_t slot, const ShellHeights& shell) const;
  /// Adds a warning if the slot's shell exceeds the surface's radius of curvature.
  void warn_of_folds(const Instance& instance, uint32_t slot, const ShellHeights& shell);
  float tile_width(const Instance& instance, uint32_t slot) const;
  uint32_t slot(const Hit& hit) const;
  /// Null if the texture coordinates are the mesh's own.
  const TextureMap* placement(const Hit& hit) const;
  TexturePoint texture_of_mesh(const Hit& hit, size_t set) const;
  /// Gradients of Hit::u and Hit::v in world space: vectors dual to the triangle's edges.
  bool find_dual_edges(const Hit& hit, Vec3d& dual1, Vec3d& dual2) const;
  Vec3 rounding(const Instance& instance, const Hit& hit) const;
  /// SurfacePoint::tangent in object space.
  Vec3 tangent(const Hit& hit) const;
  Bounds bounds_of_instances() const;
  SceneInfo count() const;

  std::vector<Mesh> meshes_;
  ShellTops tops_;  // in a committed scene, only those that are shown
  std::vector<Instance> instances_;
  std::vector<SurfaceMaterial> materials_;
  std::vector<Light> lights_;
  uint64_t flat_instances_ = 0;
  Environment environment_;
  uint8_t environment_hidden_ = 0;
  std::optional<WorldProgram> world_;  // that environment_ is baked from
  Camera camera_;
  std::optional<Mat3> rec709_to_working_;
  uint64_t unlifted_ = 0;  // instances whose shells lack texture coordinates
  std::vector<Warning> shell_warnings_;
  bool committed_ = false, geometry_changed_ = true;
  uint64_t revision_ = 0;
  bool stays_ = false;
  std::unique_ptr<SceneKeep> keep_ = std::make_unique<SceneKeep>();
  std::unique_ptr<EmbreeScene> rays_;
  std::vector<uint32_t> mesh_rays_;     // numbers of the meshes in rays_; kNoHit: not there
  std::vector<uint32_t> free_rays_;     // unused numbers in rays_
  std::unique_ptr<EmbreeScene> sides_;  // of shells, for next_side(); null: there are none
  Bounds bounds_;
  SceneInfo info_;
};

}  // namespace velour
