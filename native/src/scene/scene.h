// Everything that a picture is made of, as plain arrays.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "job/progress.h"
#include "material/texture_map.h"
#include "scene/camera.h"
#include "scene/embree_scene.h"
#include "scene/environment.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "scene/scene_keep.h"
#include "scene/shell_top.h"
#include "votf/shell_field.h"

namespace velour {

class Material;

/// What a material slot points to.
struct SurfaceMaterial {
  std::shared_ptr<const Material> material;
  Rgb emission{0.0f};         // radiance of both sides, working space
  bool rec709_colors = true;  // f is Rec. 709 (measured) and is taken to the working space; false: already there
  bool relief = false;        // it has a normal map: meshes that show it get tangents
  bool brushed = false;       // anisotropic and the same all over: +x is smooth_tangent(), meshes get tangents
  uint8_t uv_sets = 1;        // how many sets of texture coordinates it looks at, SurfaceSite::kMostSets at most
  uint8_t color_sets = 0;     // how many sets of corner colours it looks at, SurfaceSite::kMostColorSets at most
  /// Structure that lies over the surface and lets rays through; null: none. Needs texture coordinates.
  std::shared_ptr<const ShellField> shell = nullptr;
  /// The structure's own surface is what is shaded and shadowed; false: f says how the structure looks over its plane,
  /// as a BTF does.
  bool shell_shaded = false;
  /// Whether f is of a BTF whose values are means with the holes of its structure; rays find those for themselves.
  bool holed() const { return shell && !shell_shaded && !shell->volume().closed; }
  /// Metres that a tile is wide, which scale the shell's height; 0: as the texture coordinates say.
  float shell_tile = 0;
  /// Widths of the tile over which the structure's edge fades out (ShellEdge); 0: hard.
  float shell_softness = 0;
  /// Whether rays are drawn to it where it glows; false: its light is found by what surfaces reflect alone.
  bool drawn_to = true;
  /// Kinds of rays (bits of hidden) that pass through its back, the side that the mesh's normal does not point to.
  /// Shells have no such side.
  uint8_t hidden_backs = 0;
  bool hides_backs() const { return hidden_backs != 0 && !shell; }
  /// What f is multiplied with, in the working space: an artist's tint and exposure. Densities stay as they are.
  Rgb gain{1.0f};
};

/// What rays there are to an instance that some of them pass through; bits of Instance::hidden, and values of velour.h.
namespace hidden {
inline constexpr uint8_t kFromCamera = 1, kFromBounces = 2, kFromShadows = 4;
/// Not a kind of ray: the camera sees it as nothing, and nothing behind it.
inline constexpr uint8_t kHoldout = 8;
}  // namespace hidden

/// A hit, resolved to what shading needs. World space.
struct SurfacePoint {
  Vec3 position;
  Vec3 geometric_normal;  // unit, towards the mesh's front
  Vec3 shading_normal;    // unit, interpolated, towards the mesh's front
  Vec3 tangent;           // along the first texture coordinate as placed, not normalised; zero when there is none
  float error;            // bound of |position - exact|, per coordinate
  uint32_t material;
  /// Vector from `position` to the smooth surface that the shading normals belong to, on the mesh's front; zero unless
  /// the instance softens its shadow terminator.
  Vec3 rounding{0.0f};
  float terminator = 0;  // cosine below which shadow rays begin on that surface; 0: nowhere
};

/// Of a scene that is rendered; those that are only traced need none.
inline constexpr const char* kNoLightWarning = "The scene has no light.";
/// What a material that varies over the surface needs beside it, as placed. Of a mesh without texture coordinates, or
/// with ones that are not finite, it is that of (0, 0), without gradients.
struct TexturePoint {
  Vec2 uv{0.0f};
  /// d uv / d position on the triangle's plane, world space, for any transform of the instance; zero where the triangle
  /// is too small for float64.
  Vec3 u_gradient{0.0f}, v_gradient{0.0f};
};

struct SceneInfo {
  uint64_t triangles = 0;  // over all instances
  uint64_t instances = 0, meshes = 0, lights = 0, materials = 0;
  uint64_t bytes = 0;  // hierarchy, meshes, environment
  double bvh_seconds = 0;
  std::vector<std::string> warnings;
};

/// What bends a shell at a hit, world space.
struct ShellFrame {
  const ShellField* field;
  float softness;  // of its edge, widths
  Vec3 normal;     // unit, interpolated, towards the mesh's front
  float scale;     // widths of the tile that a metre along the normal covers
  Vec2 uv;         // texture coordinates, as placed
  // Along the direction that was asked for:
  float curvature = 0;     // normal curvature, 1 / metres
  Vec3 normal_turn{0.0f};  // what the normal changes by, 1 / metres
  Vec2 uv_along{0.0f};     // what the texture coordinates change by, 1 / metres
};

/// Fill, commit, render. Every change after commit() needs another commit(), which builds anew no more than what has
/// changed. Reading a committed scene is thread-safe.
class Scene {
 public:
  /// These return the number of what was added, counted from 0. Arguments that name missing things throw
  /// Error(invalid_argument).
  uint32_t add_mesh(Mesh mesh);
  /// Takes what there is of a mesh that no instance shows; its number stays, of a mesh without triangles.
  void remove_mesh(uint32_t number);
  uint32_t add_material(SurfaceMaterial material);
  /// Puts another material in the place of one. A committed scene stays committed, unless one of the two has a shell
  /// and the other none of the same heights, or the new one alone needs tangents; nothing may read it meanwhile. A
  /// shell keeps tile and softness; the gain stays.
  void set_material(uint32_t number, SurfaceMaterial material);
  /// Puts the material that was added last in the place of `number`, and takes it from the end.
  void replace_material(uint32_t number);
  /// SurfaceMaterial::shell_tile. Throws Error(invalid_argument) for a material without a shell.
  void set_shell_tile(uint32_t material, float metres);
  /// SurfaceMaterial::shell_softness, below 1. As above. A committed scene stays committed.
  void set_shell_softness(uint32_t material, float widths);
  /// SurfaceMaterial::gain, finite and at least 0. A committed scene stays committed.
  void set_gain(uint32_t material, const Rgb& gain);
  /// SurfaceMaterial::hidden_backs. A committed scene stays committed.
  void set_hidden_backs(uint32_t material, uint8_t from);
  /// SurfaceMaterial::drawn_to. A committed scene stays committed.
  void set_drawn_to(uint32_t material, bool drawn);
  /// `materials[s]` serves slot s of the mesh; slots beyond the list use its last entry. An instance without volume (a
  /// zero scale) is left out and counted in the warnings. `placements[s]` takes the mesh's texture coordinates to those
  /// that slot s is shown with, and with them its footprints and its tangents; none: they are the same.
  /// `hidden_from`: bits of `hidden`. `terminator`: cosine, 0 to 1, below which shadow rays begin on the smooth surface
  /// that the mesh stands for (Vertex::shadow_ray); 0: always on the mesh.
  void add_instance(uint32_t mesh, const Affine& object_to_world, std::vector<uint32_t> materials,
                    std::vector<TextureMap> placements = {}, uint8_t hidden_from = 0, float terminator = 0);
  void clear_instances();
  uint32_t add_light(const Light& light);
  void clear_lights();
  void set_environment(Environment environment);
  void set_camera(const Camera& camera);
  /// Camera::framing of all instances.
  void frame_camera(float aspect, int up_axis);
  /// Takes Rec. 709 colours to the space of all other colours of the scene and of the film.
  void set_working_space(const Mat3& rec709_to_working);

  /// Checks the scene and builds the hierarchy with at most `threads` threads (0: all); nothing, if it is committed.
  /// Throws Error(cancelled) soon after `progress` was; another commit() then goes on where that one ended.
  void commit(int threads = 0, const Progress* progress = nullptr);
  /// Says before the first commit() that no geometry changes after it: rays take less time (EmbreeScene::Levels). Where
  /// some does, it is rebuilt. The last bits of hits differ from those of a scene that may change.
  void stay() { stays_ = true; }
  bool committed() const { return committed_; }
  /// Another number after every change but that of the camera alone.
  uint64_t revision() const { return revision_; }
  /// The T that all who ask share until the revision is another: what is worked out from the scene is worked out once.
  template <typename T>
  std::shared_ptr<T> kept() const {
    return keep_->of<T>(revision_);
  }

  struct Instance {
    uint32_t mesh;
    Affine object_to_world;
    Mat3 normal_to_world;
    std::vector<uint32_t> materials;
    std::vector<TextureMap> placements;  // as many, or none
    uint8_t hidden;
    float terminator = 0;  // as of SurfacePoint
    /// Set by commit(): what rays meet in the place of the mesh, where a material has a shell; what of both the
    /// hierarchy has, by its number there; and how wide a tile of each slot's shell is, in metres.
    const ShellTop* top = nullptr;
    uint32_t traced = kNoHit;
    std::vector<float> tile_width = {};
    uint32_t sides = kNoHit;  // number of the instance of their sides alone; kNoHit: the shell has none
  };
  const std::vector<Mesh>& meshes() const { return meshes_; }
  /// Hit::instance counts these.
  const std::vector<Instance>& instances() const { return instances_; }

  /// What rays() has of an instance: its mesh, or the top of its shell with the sides.
  const Mesh& traced_mesh(const Instance& i) const { return i.top != nullptr ? i.top->mesh : meshes_[i.mesh]; }

  const EmbreeScene& rays() const { return *rays_; }
  SurfacePoint surface(const Hit& hit) const;
  /// Number of the material that was hit.
  uint32_t material(const Hit& hit) const;
  bool is_holdout(const Hit& hit) const { return (instances_[hit.instance].hidden & hidden::kHoldout) != 0; }
  /// Apart from surface(): most materials are uniform. Only the first set of texture coordinates is placed.
  TexturePoint texture(const Hit& hit, size_t set = 0) const;
  /// Mesh::color there.
  Rgb color(const Hit& hit, size_t set) const {
    return traced_mesh(instances_[hit.instance]).color(hit.triangle, {hit.u, hit.v}, set);
  }
  /// What the components of a normal map are along at a hit, world space: tangent, bitangent, normal, towards the
  /// mesh's front, not normalised. Zero without texture coordinates, or where no material of the mesh has a map.
  Mat3 relief(const Hit& hit) const;
  /// Whether a hit is on the top of a shell, or on a side.
  bool has_shell(const Hit& hit) const {
    const Instance& instance = instances_[hit.instance];
    return !instance.tile_width.empty() && instance.tile_width[slot(hit)] > 0;
  }
  /// The top's point at such a hit: itself; of a hit on the side of a shell, the point of the border over it.
  struct ShellFoot {
    Hit top;
    bool is_side = false;
    float below = 0;  // how far below the top the hit is, of the shell's height
  };
  ShellFoot shell_foot(const Hit& hit) const;
  /// Whether the shell ends anywhere, and so has sides.
  bool has_sides(const Hit& hit) const { return instances_[hit.instance].sides != kNoHit; }
  /// How far it is to the first of the sides of the shell that is hit which leads into it, or out of it; infinite where
  /// the ray meets none.
  float next_side(const Hit& hit, Ray ray, bool inwards) const;
  /// Of a top's hit, along unit `direction` as far as it lies in the surface.
  ShellFrame shell(const Hit& hit, const Vec3& direction) const;

  const Camera& camera() const { return camera_; }
  const Environment& environment() const { return environment_; }
  const std::vector<Light>& lights() const { return lights_; }
  const std::vector<SurfaceMaterial>& materials() const { return materials_; }
  /// Nothing when Rec. 709 is the working space.
  const std::optional<Mat3>& rec709_to_working() const { return rec709_to_working_; }
  /// Of all instances, as committed.
  const Bounds& bounds() const { return bounds_; }
  const SceneInfo& info() const { return info_; }

 private:
  void changed();           // what is traced stays
  void geometry_changed();  // a mesh, an instance, a shell
  void build_rays(int threads, const Progress* progress);
  /// Has the hierarchy hold a mesh or a top, or not; `number`: where it does, else kNoHit.
  void trace(const Mesh& mesh, bool is_traced, uint32_t& number);
  void drop_tops(uint32_t mesh);
  SurfaceMaterial& with_shell(uint32_t material, const char* to_what);
  void make_tangents();
  void lift_shells(const Progress* progress);
  void lift(Instance& instance);
  void build_sides(int threads);
  ShellFolds folds(const Instance& instance, uint32_t slot, const ShellHeights& shell) const;
  /// A warning where the slot's shell is higher than the surface's radius of curvature.
  void warn_of_folds(const Instance& instance, uint32_t slot, const ShellHeights& shell);
  float tile_width(const Instance& instance, uint32_t slot) const;
  uint32_t slot(const Hit& hit) const;
  /// Null where texture coordinates are the mesh's own.
  const TextureMap* placement(const Hit& hit) const;
  TexturePoint texture_of_mesh(const Hit& hit, size_t set) const;
  Vec3 rounding(const Instance& instance, const Hit& hit) const;
  /// SurfacePoint::tangent in the object's space.
  Vec3 tangent(const Hit& hit) const;
  Bounds bounds_of_instances() const;
  SceneInfo count() const;

  std::vector<Mesh> meshes_;
  ShellTops tops_;  // of a committed scene those that are shown
  std::vector<Instance> instances_;
  std::vector<SurfaceMaterial> materials_;
  std::vector<Light> lights_;
  uint64_t flat_instances_ = 0;
  Environment environment_;
  Camera camera_;
  std::optional<Mat3> rec709_to_working_;
  uint64_t unlifted_ = 0;  // instances whose shells lack texture coordinates
  std::vector<std::string> shell_warnings_;
  bool committed_ = false, geometry_changed_ = true;
  uint64_t revision_ = 0;
  bool stays_ = false;
  std::unique_ptr<SceneKeep> keep_ = std::make_unique<SceneKeep>();
  std::unique_ptr<EmbreeScene> rays_;
  std::vector<uint32_t> mesh_rays_;     // numbers of the meshes in rays_; kNoHit: it does not have them
  std::vector<uint32_t> free_rays_;     // numbers there of nothing
  std::unique_ptr<EmbreeScene> sides_;  // of shells, for next_side(); null: there are none
  Bounds bounds_;
  SceneInfo info_;
};

}  // namespace velour
