/* Velour: measured materials. The only public header, and longer than others, so that one file is all that a program
 * needs; pure C99.
 *
 * Every call that can fail returns vlr_status; vlr_last_error() then holds one sentence for the user (file, field,
 * value, remedy), kept for the calling thread until its next failing call. Nothing here prints, exits or aborts.
 *
 * Handles are opaque. A handle keeps alive what it needs, so they may be freed in any order; freeing NULL is fine. A
 * handle may be used by one thread at a time, except that a vlr_job may be polled, cancelled and read from any thread.
 * Models and measurements are immutable and may be shared freely. Calls that take long keep what they read of a model,
 * measurement, BTF or observation: once they have begun, another thread may free it.
 *
 * Options structs begin with their size: call the matching vlr_*_options_init() first, then change fields. Defaults
 * live in the library only. Arrays are borrowed for the call: float32, row-major, contiguous. Strings are UTF-8. A
 * `const char**` that a call fills belongs to the handle and is valid until the handle is freed or the same call is
 * repeated.
 *
 * Directions are unit, point away from the surface, in the local shading frame: +z normal, +x tangent. wl points to the
 * light, wv to the viewer. f is the BRDF in 1/sr without the cosine, linear Rec. 709. Angles in radians, lengths in
 * metres unless a name says otherwise.
 */
#ifndef VELOUR_H
#define VELOUR_H

#include <stdint.h>

#if defined(_WIN32)
#define VLR_API __declspec(dllexport)
#else
#define VLR_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Rises whenever a struct or the meaning of a call changes. */
#define VLR_ABI_VERSION 10

typedef int32_t vlr_status;
enum {
  VLR_OK = 0,
  VLR_UNKNOWN = 1,
  VLR_INVALID_ARGUMENT = 2,
  VLR_INVALID_STATE = 3,
  VLR_OUT_OF_MEMORY = 4,
  VLR_UNSUPPORTED = 5,
  VLR_IO = 6,
  VLR_BAD_DATA = 7,
  VLR_CANCELLED = 8,
  VLR_VERSION_MISMATCH = 9
};

typedef struct vlr_measurement vlr_measurement;
typedef struct vlr_btf vlr_btf;
typedef struct vlr_model vlr_model;
typedef struct vlr_scene vlr_scene;
typedef struct vlr_texture vlr_texture;         /* a picture that stands for a number of a material */
typedef struct vlr_shader vlr_shader;           /* what a material is mixed and added of, being made */
typedef struct vlr_observation vlr_observation; /* what scenes show of one material */
typedef struct vlr_tile vlr_tile;               /* procedural mesostructure */
typedef struct vlr_plot vlr_plot;               /* what is known of a model, as numbers and as a picture */
typedef struct vlr_job vlr_job;

/* ---- library ------------------------------------------------------------------------------------------------- */

/* Sentence of this thread's last failing call; "" before the first. */
VLR_API const char* vlr_last_error(void);
/* major * 10000 + minor * 100 + patch. */
VLR_API uint32_t vlr_version(void);
VLR_API uint32_t vlr_abi_version(void);
/* Checks that the ray tracer bound to this library is the one it was built for (version, one known ray hits). Every
 * scene and capture call does this first; call it at load time to learn of trouble early. */
VLR_API vlr_status vlr_self_test(void);
/* JSON: version, embree {version, path}, simd, simd_targets, threads, build_type. The text belongs to the library. */
VLR_API vlr_status vlr_system_json(const char** json);
/* Pins the instruction set of all kernels: "auto", or a name of simd_targets. Not while a job runs. */
VLR_API vlr_status vlr_select_simd(const char* target);

/* ---- measurements -------------------------------------------------------------------------------------------- */

/* Reads a measurement file; the format is recognised from its content. */
VLR_API vlr_status vlr_measurement_load(const char* path, vlr_measurement** out);
/* The same in the background; vlr_job_result_measurement gives it. JSON: as vlr_measurement_info_json. A cancel is
 * heeded once the file is read. */
VLR_API vlr_status vlr_measurement_load_create_job(const char* path, vlr_job** out);
VLR_API void vlr_measurement_free(vlr_measurement* measurement);
/* JSON: kind "measurement", format, name, path, sha256, bytes, isotropic, entries {total, valid, negative, not_finite,
 * below_horizon, out_of_gamut}, details {...}. */
VLR_API vlr_status vlr_measurement_info_json(vlr_measurement* measurement, const char** json);
/* f [count x 3] of one view wv [3] and `count` light directions wl [count x 3]; valid [count] is 1 where covered. */
VLR_API vlr_status vlr_measurement_eval(const vlr_measurement* measurement, const float* wv, uint64_t count,
                                        const float* wl, float* f, uint8_t* valid);

/* ---- models -------------------------------------------------------------------------------------------------- */

VLR_API vlr_status vlr_model_load(const char* path, vlr_model** out);
/* The bytes of a model file in memory (a packed image); `name` appears in error sentences. */
VLR_API vlr_status vlr_model_load_memory(const void* bytes, uint64_t size, const char* name, vlr_model** out);
VLR_API void vlr_model_free(vlr_model* model);
/* Writes atomically: the old file or the new one, never a part. */
VLR_API vlr_status vlr_model_save(const vlr_model* model, const char* path);
/* The bytes that vlr_model_save would write; they belong to the handle. */
VLR_API vlr_status vlr_model_bytes(vlr_model* model, const void** bytes, uint64_t* size);
/* The model of a surface that is rougher by `roughness`, 0 to 1: a mirror gets about the highlight of a GGX or Beckmann
 * surface of alpha = roughness^2, and other highlights are widened as much. Albedos stay (docs/parametric.md). A model
 * of its own, with samples and densities of its own; 0 gives the same one. VLR_INVALID_ARGUMENT for models of BTFs. */
VLR_API vlr_status vlr_model_roughened(const vlr_model* model, float roughness, vlr_model** out);
/* JSON: kind "model", model "scattered" or "parametric", kernel, isotropic, lobes, bytes, parameter_bytes, relative_l2,
 * by_view_angle, albedo_by_view_angle, albedo_max, reciprocity, measured_reciprocity, tolerance, seconds, seed,
 * all_data, warnings, order (as of a fit), source {name, format, sha256}. Scattered: also views, max_lobes_per_view.
 * Parametric: also cells, view_range [from, to] in degrees, spaces {light, half}, the lobes of each, and scene (as of
 * a fit) when it was reduced. Of BTFs (model "factored-btf", "srbf-btf" or "tensor-btf") instead: method, psnr,
 * psnr_held_out, ser, p99, raw_bytes, evaluations_per_second (of one thread, null in older files), seconds, seed,
 * warnings, texels, tile_metres, views, lights, companding; components, or coefficients (of the side that has most), of
 * SRBFs lobes, and sides: view and light ("above", "below"), parameter_bytes, as (null, or the number of the side that
 * serves this one, whose own fields are null) and lobes {tile, texel}, or clusters, members, ranks {texel, view, light,
 * color}, relief (whether there is one) and bytes of each part {coefficients, members, relief, factors, cores, scales},
 * which add up to parameter_bytes. */
VLR_API vlr_status vlr_model_info_json(vlr_model* model, const char** json);
/* As vlr_measurement_eval; also the density of the model's own sampler when `pdf` [count] is not NULL. */
VLR_API vlr_status vlr_model_eval(const vlr_model* model, const float* wv, uint64_t count, const float* wl, float* f,
                                  float* pdf);
/* `count` directions wl [count x 3] drawn for view wv from random numbers u [count x 2] in [0, 1), and their density.
 * A direction may lie below the horizon. */
VLR_API vlr_status vlr_model_sample(const vlr_model* model, const float* wv, uint64_t count, const float* u, float* wl,
                                    float* pdf);

/* JSON of vlr_measurement_info_json, vlr_model_info_json, vlr_observation_info_json or vlr_btf_info_json, whichever the
 * file or folder is; the text belongs to the thread until its next call of this function. */
VLR_API vlr_status vlr_file_info_json(const char* path, const char** json);

/* ---- bidirectional texture functions ------------------------------------------------------------------------- */

/* What numbers of pictures and of .btf files mean (docs/btf.md). */
enum {
  VLR_BTF_AUTOMATIC = 0,   /* as they say of themselves; other pictures: radiance; .btf files: BRDF */
  VLR_BTF_BRDF = 1,        /* apparent BRDF, 1/sr */
  VLR_BTF_REFLECTANCE = 2, /* pi times it */
  VLR_BTF_RADIANCE = 3     /* pi cos(theta_l) times it */
};
enum { VLR_BTF_REC709 = 0, VLR_BTF_XYZ = 1 };
/* Automatic: degrees, and refused where they look like radians. */
enum { VLR_BTF_ANGLES_AUTOMATIC = 0, VLR_BTF_DEGREES = 1, VLR_BTF_RADIANS = 2 };

typedef struct vlr_btf_options {
  uint32_t struct_size;
  int32_t values;       /* VLR_BTF_AUTOMATIC ... */
  int32_t colors;       /* of pictures: VLR_BTF_REC709 or VLR_BTF_XYZ */
  float gamma;          /* of pictures of whole numbers: linear = stored^gamma; 0: the sRGB curve */
  float tile_metres[2]; /* size of the tile along x and y; 0 0: what the source says, if it says anything */
  const char* layer;    /* of OpenEXR pictures, as in vlr_picture_options; NULL or "": the picture itself */
  int32_t angles;       /* of a CSV index: VLR_BTF_ANGLES_AUTOMATIC ... */
} vlr_btf_options;
VLR_API void vlr_btf_options_init(vlr_btf_options* options);

/* Opens a BTF: a folder of Velour's own, a folder of pictures named for their angles (UBO2003), a CSV index of
 * pictures, or a .btf file of Bonn (UBO2014). Pixels are read when asked for. */
VLR_API vlr_status vlr_btf_load(const char* path, const vlr_btf_options* options, vlr_btf** out);
VLR_API void vlr_btf_free(vlr_btf* btf);
/* JSON: kind "btf", format, name, path, description, sha256, bytes, raw_bytes (as half-float RGB), texels [x, y],
 * views, lights, pairs, complete, largest_theta {view, light} (degrees), tile_metres [x, y] or null, shell {thickness,
 * reference_height} or null, errors, structure, entries {pairs, values, not_finite, negative} (of so many pairs, spread
 * where not all), details {...}. */
VLR_API vlr_status vlr_btf_info_json(vlr_btf* btf, const char** json);
/* theta_l, phi_l, theta_v, phi_v of every pair in degrees, angles [pairs x 4]; `count` is the number of doubles. */
VLR_API vlr_status vlr_btf_angles(const vlr_btf* btf, double* angles, uint64_t count);
/* Apparent BRDFs (1/sr, without cosine, linear Rec. 709) as half floats: halves [pairs x rows x columns x 3] of the
 * pairs [first, first + pairs), row 0 at the bottom (y = 0); `count` is the number of halves. */
VLR_API vlr_status vlr_btf_read(const vlr_btf* btf, uint64_t first, uint64_t pairs, uint16_t* halves, uint64_t count);
/* Writes one OpenEXR picture of half floats a pair into the new folder `path`, named for its angles where all of them
 * are whole degrees, else listed in btf.csv. JSON: format "ubo2003" or "csv", pictures, bytes, seconds. */
VLR_API vlr_status vlr_btf_export_create_job(const vlr_btf* btf, const char* path, vlr_job** out);

/* ---- jobs ---------------------------------------------------------------------------------------------------- */

enum { VLR_JOB_READY = 0, VLR_JOB_RUNNING = 1, VLR_JOB_DONE = 2, VLR_JOB_FAILED = 3, VLR_JOB_CANCELLED = 4 };

typedef struct vlr_job_state {
  uint32_t struct_size;
  int32_t state;         /* VLR_JOB_* */
  double fraction;       /* 0..1, never falls, 1 only when done */
  double seconds;        /* since the start */
  double seconds_left;   /* estimate; negative while unknown */
  uint64_t bytes_in_use; /* of the whole process */
  const char* stage;     /* a literal, valid for ever */
} vlr_job_state;

/* For C callers: called on the thread that called vlr_job_wait, about ten times a second, fraction non-decreasing, the
 * last one 1 when the job ends well. Non-zero goes on, 0 cancels. */
typedef int32_t (*vlr_progress_fn)(void* user, double fraction, const char* stage);

/* Starts the job on a thread of its own. A cancelled or failed job may be started again. */
VLR_API vlr_status vlr_job_start(vlr_job* job);
VLR_API vlr_status vlr_job_poll(const vlr_job* job, vlr_job_state* state);
/* Asks for the end; the job stops within 0.1 s. */
VLR_API vlr_status vlr_job_cancel(vlr_job* job);
/* Waits at most `timeout_seconds` (negative: for ever) for the end. *finished is 0 when time ran out (and the status
 * VLR_OK). When the job failed or was cancelled its status and sentence are returned here. `progress` may be NULL. */
VLR_API vlr_status vlr_job_wait(vlr_job* job, double timeout_seconds, vlr_progress_fn progress, void* user,
                                int32_t* finished);
/* What a finished job reports, as JSON: the keys of the command line's verb. */
VLR_API vlr_status vlr_job_report_json(vlr_job* job, const char** json);
/* The model of a finished fit; a new handle. */
VLR_API vlr_status vlr_job_result_model(const vlr_job* job, vlr_model** out);
/* The measurement that a finished job has read; a new handle. */
VLR_API vlr_status vlr_job_result_measurement(const vlr_job* job, vlr_measurement** out);
/* The table of a finished job of those that make tables for shaders (vlr_light_map_create_job and the four below it):
 * [height][width][4] floats, which belong to the job. */
VLR_API vlr_status vlr_job_result_table(const vlr_job* job, const float** rgba, uint32_t* width, uint32_t* height);
/* Cancels if running, waits, frees. */
VLR_API void vlr_job_free(vlr_job* job);

/* ---- fit, compare, capture ----------------------------------------------------------------------------------- */

enum { VLR_KERNEL_GAUSSIAN = 0, VLR_KERNEL_ABEL_POISSON = 1 };
enum {
  VLR_MODEL_SCATTERED = 0, /* lobes of each sampled view; views are mixed at run time */
  VLR_MODEL_PARAMETRIC = 1 /* few lobes for all views, their parameters splines of the view; Gaussian only */
};

typedef struct vlr_fit_options {
  uint32_t struct_size;
  int32_t kernel;     /* VLR_KERNEL_* */
  double tolerance;   /* relative L2 asked for at every view up to 75 degrees, twice that beyond; 0.02 */
  uint32_t max_lobes; /* scattered: a view; parametric: in all; 16 */
  uint32_t threads;   /* 0: all */
  uint64_t max_bytes; /* of the model file; 0: no bound */
  uint64_t seed;
  int32_t all_data;     /* 1: hold nothing out (production); the model says so */
  int32_t align_views;  /* scattered, 1: turn neighbouring slices onto the query's mirror direction before mixing */
  int32_t model;        /* VLR_MODEL_* */
  int32_t limit_albedo; /* parametric, 1: lower the model where more light would leave than arrives */
  int32_t symmetric;    /* parametric, 1: f is the mean of both orders of a pair, reciprocal; evaluation costs more */
  int32_t pad;
  /* Reduce a parametric model to what scenes show of the material: fewer lobes over the views seen, as long as pictures
   * are no worse than those of the full model. NULL: for any scene. */
  const vlr_observation* for_scene;
  const vlr_model* full_model; /* with for_scene: the full model; NULL: it is fitted first */
} vlr_fit_options;
VLR_API void vlr_fit_options_init(vlr_fit_options* options);
/* Result: a model. JSON: lobes, bytes, parameter_bytes, seconds, relative_l2, by_view_angle, albedo_max, reciprocity,
 * measured_reciprocity, warnings, order {lobes [], parameter_bytes [], worst [], relative_l2 [], chosen}: how the error
 * falls as the model grows. `worst` is the largest relative L2 over tolerance of any fitted view, `chosen` the number
 * of the point that the model is, or null. Parametric: also view_range [from, to], the degrees that the model is for.
 * With for_scene also scene {frames, light_density, hash, picture_error, full_picture_error, full_parameter_bytes}:
 * errors are the relmse at the observed hits against the measurement, of this model and of the full one. */
VLR_API vlr_status vlr_fit_create_job(const vlr_measurement* measurement, const vlr_fit_options* options,
                                      vlr_job** out);

/* JSON: relative_l2, by_view_angle, log_rms, noise_by_view_angle, samples, narrow_views. */
VLR_API vlr_status vlr_compare_create_job(const vlr_measurement* measurement, const vlr_model* model, vlr_job** out);
/* Analytic materials to compare with: the GGX lobe over a diffuse base that the strategies `ggx` and `mis-ggx` draw
 * from, and Blender's Principled material: all of it, or without coat and specular tint, which Blender before 4.0 has
 * not alike. */
enum { VLR_PEER_GGX = 0, VLR_PEER_PRINCIPLED = 1, VLR_PEER_PLAIN_PRINCIPLED = 2 };
/* The same of the peer (VLR_PEER_*) that suits the measurement best. JSON: also seconds (of its fit), parameter_bytes,
 * and ggx {alpha [x, y], f0, f90, diffuse} or principled {base_color, metallic, roughness, specular,
 * specular_tint, coat, coat_roughness}; colours linear Rec. 709. */
VLR_API vlr_status vlr_compare_peer_create_job(const vlr_measurement* measurement, int32_t peer, vlr_job** out);
/* The same of the peer that suits a model best: errors are those against the model, of a BTF against its mean over the
 * tile. Views that the model is not made for are null. */
VLR_API vlr_status vlr_model_peer_create_job(const vlr_model* model, int32_t peer, vlr_job** out);

typedef struct vlr_microsurface_options {
  uint32_t struct_size;
  uint32_t threads;     /* 0: all */
  double roughness;     /* Beckmann alpha = sqrt(2) x RMS slope along x; 0.01..1 */
  double anisotropy;    /* alpha_x / alpha_y >= 1; 1: isotropic, MERL layout */
  const char* metal;    /* "nickel", "gold", "copper", "aluminium", "silver", "iron", "chromium", "titanium" */
  float base_albedo[3]; /* diffuse base under the metal flakes; 0 0 0: bare metal */
  double base_share;    /* share of the surface that is diffuse base; 0..1 */
  /* Refractive index of a clear surface, 1.05..3; 0: none. Roughness and anisotropy are then its own; base and metal
   * lie below it, as pigment and flakes. */
  double ior;
  double flake_roughness; /* Beckmann alpha of the flakes below a clear surface; 0.01..0.4 */
  uint64_t rays;          /* camera-side rays in all; more is finer and slower */
  uint64_t seed;
} vlr_microsurface_options;
VLR_API void vlr_microsurface_options_init(vlr_microsurface_options* options);
/* Ray-traces a random micro-surface and writes its BRDF: MERL layout when isotropic, else a Velour EXR table.
 * JSON: seconds, rays, rays_per_second, bytes, resolution_degrees, relative_standard_error, albedo. */
VLR_API vlr_status vlr_microsurface_create_job(const vlr_microsurface_options* options, const char* path,
                                               vlr_job** out);

/* ---- compression of BTFs ------------------------------------------------------------------------------------- */

enum {
  VLR_COMPRESS_SVD = 0,     /* truncated singular values */
  VLR_COMPRESS_SRBF = 1,    /* multivariate SRBFs over a relief */
  VLR_COMPRESS_TUCKER = 2,  /* clustered tensors: of one cluster, ... */
  VLR_COMPRESS_CTA = 3,     /* ... of some, each texel in one of them, ... */
  VLR_COMPRESS_KCTA = 4,    /* ... or in a few */
  VLR_COMPRESS_SVD_VIEW = 5 /* singular values of each view for itself */
};
enum { VLR_COMPAND_NONE = 0, VLR_COMPAND_ROOT = 1 };
typedef struct vlr_compress_options {
  uint32_t struct_size;
  int32_t method;     /* VLR_COMPRESS_*; SRBF */
  int32_t companding; /* VLR_COMPAND_*: sums of f itself, or of its square root (errors count about as they are seen) */
  uint32_t threads;   /* 0: all */
  uint64_t bytes;     /* of all coefficients at most; 0: 1:400 of the BTF as half floats (SVDs: 1:200), or a few; with a
                       * tolerance: whatever that takes */
  uint64_t seed;
  const vlr_btf* held_out; /* pairs that no fit has seen, of the same texels; NULL: none */
  /* Make it as small as pictures of these scenes allow, observed with a material of the BTF: it is fitted anew at the
   * resolution and for the views that they show, or the levels that no ray resolves are left out (docs/for_scene.md).
   * NULL: for any scene. */
  const vlr_observation* for_scene;
  const vlr_model* full_model; /* with for_scene: the BTF's full model; NULL: it is fitted first */
  /* Of the relative L2 error of companded values (docs/conventions.md): the smallest model within it. 0: none. */
  double tolerance;
  uint64_t memory; /* bytes that the fit may hold at once, the process as it was not counted; 0: no limit */
  /* Finished stages are kept in this file while the fit runs, written whole or not at all; it is gone after a success.
   * NULL: nothing is kept. With `resume` what it holds of the same BTF and options is not done again, and the model has
   * the bits of a fit that was not interrupted; a file of anything else is replaced, with a warning. */
  const char* checkpoint;
  int32_t resume;
  /* Of clustered tensors: clusters of a side (up to 256; TUCKER: 1), and how many of them a texel is made of (up to 8;
   * TUCKER, CTA: 1). 0: what leaves least within the bytes is looked for. */
  uint32_t clusters;
  uint32_t members;
  int32_t no_relief; /* not of SVDs: texels are of the reference plane, not of the structure's surface */
} vlr_compress_options;
VLR_API void vlr_compress_options_init(vlr_compress_options* options);
/* Fits a model to a BTF; vlr_job_result_model gives it. JSON: bytes, parameter_bytes, ratio (raw half floats / bytes),
 * psnr, psnr_held_out (null without held_out), ser, relative_l2, p99, evaluations_per_second, seconds, warnings,
 * tolerance, order as of vlr_fit_create_job (lobes: coefficients of a texel, or components; worst: relative_l2 over the
 * tolerance, or relative_l2 without one), search [{coefficients, parameter_bytes, expected, relative_l2}], the fits in
 * their order; of clustered tensors shapes [{clusters, members, texel_rank, view_rank, light_rank, color_rank,
 * parameter_bytes, expected}], those that were tried before the fit; components of SVDs; lobes and coefficients of
 * SRBFs. With for_scene also texels [x, y], the finest that are left, and scene, as of vlr_fit_create_job, but with
 * full_texels [x, y] and surface (vlr_observation_info_json) in place of errors; psnr, ser and speed are then those of
 * the full model. */
VLR_API vlr_status vlr_compress_create_job(const vlr_btf* btf, const vlr_compress_options* options, vlr_job** out);
/* What such a fit is about to take, by the BTF's sizes alone, of all its sides: which ones are dark or alike is found
 * by reading them. memory: bytes that it holds at once where nothing limits it, the process as it was not counted;
 * least_memory: the least `memory` of the options that it can be kept to; bytes: of all coefficients, at most. Each may
 * be NULL. Fails with VLR_UNSUPPORTED for a BTF whose views lack lights. */
VLR_API vlr_status vlr_compress_size(const vlr_btf* btf, const vlr_compress_options* options, uint64_t* memory,
                                     uint64_t* least_memory, uint64_t* bytes);
/* Errors of a BTF's model against the BTF's own pairs. JSON: psnr, ser, relative_l2, brightness, p99, pairs. */
VLR_API vlr_status vlr_btf_compare_create_job(const vlr_btf* btf, const vlr_model* model, vlr_job** out);
/* The same of another BTF of the same texels, interpolated between its own pairs; white is its own 99th percentile. */
VLR_API vlr_status vlr_btf_compare_btf_create_job(const vlr_btf* btf, const vlr_btf* other, vlr_job** out);

/* ---- scene --------------------------------------------------------------------------------------------------- */

VLR_API vlr_status vlr_scene_create(vlr_scene** out);
VLR_API void vlr_scene_free(vlr_scene* scene);

/* Colours of measurements, models and presets are Rec. 709; `rec709_to_working` [9, row-major] takes them to the space
 * of all other colours and images of the scene and of the film. Default: identity. */
VLR_API vlr_status vlr_scene_set_working_space(vlr_scene* scene, const float* rec709_to_working);

/* Sets of texture coordinates that a material can look at. */
enum { VLR_MOST_UV_SETS = 4 };
/* Sets of corner colours likewise. */
enum { VLR_MOST_COLOR_SETS = 4 };
typedef struct vlr_mesh_desc {
  uint32_t struct_size;
  uint32_t vertex_count;
  uint32_t triangle_count;
  uint32_t color_sets;            /* VLR_MOST_COLOR_SETS at most */
  const float* positions;         /* [vertex_count x 3] */
  const uint32_t* triangles;      /* [triangle_count x 3] */
  const float* corner_normals;    /* [triangle_count x 3 x 3] shading normals; NULL: vertex_normals */
  const float* corner_uvs;        /* [triangle_count x 3 x 2]; NULL: none */
  const uint32_t* material_slots; /* [triangle_count]; NULL: all 0 */
  const uint8_t* smooth;          /* [triangle_count] 0: flat; used when corner_normals is NULL; NULL: all smooth */
  const float* more_uvs;          /* [more_uv_sets x triangle_count x 3 x 2] sets 1, 2, ... beside corner_uvs, set 0 */
  const float* relief_uvs;        /* [triangle_count x 3 x 2] what MikkTSpace tangents follow; NULL: set 0 */
  uint32_t more_uv_sets;          /* VLR_MOST_UV_SETS - 1 at most */
  uint32_t corner_count;
  /* Not NULL: `triangles` name corners of faces, these are the vertices of those [corner_count], and what is said to be
   * triangle_count x 3 is corner_count: nothing need be spread over the triangles that faces are cut into. */
  const uint32_t* corner_vertices;
  const float* vertex_normals; /* [vertex_count x 3] of what is smooth; NULL: means of the triangles about a vertex */
  const float* corner_colors;  /* [color_sets x triangle_count x 3 x 3] of vlr_texture_of_corners, working space */
} vlr_mesh_desc;
/* Degenerate triangles and non-finite vertices are left out; *dropped (may be NULL) says how many triangles. */
VLR_API vlr_status vlr_scene_add_mesh(vlr_scene* scene, const vlr_mesh_desc* desc, uint32_t* mesh, uint32_t* dropped);
/* Takes what there is of a mesh that no instance shows; its number stays, of a mesh without triangles. */
VLR_API vlr_status vlr_scene_remove_mesh(vlr_scene* scene, uint32_t mesh);
/* Many, which are built side by side: all or none are added, numbered one after the other from *first. descs [count]
 * are all of the struct_size of the first; dropped [count] may be NULL. */
VLR_API vlr_status vlr_scene_add_meshes(vlr_scene* scene, const vlr_mesh_desc* descs, uint64_t count, uint32_t* first,
                                        uint32_t* dropped);
/* Reads a Wavefront OBJ file, or a Stanford PLY file by its extension .ply. */
VLR_API vlr_status vlr_scene_load_mesh(vlr_scene* scene, const char* path, uint32_t* mesh);

/* Materials are numbered in the order of adding. */
/* Puts the material that was added last in the place of `material`, and takes it from the end. */
VLR_API vlr_status vlr_scene_replace_material(vlr_scene* scene, uint32_t material);
VLR_API vlr_status vlr_scene_add_model_material(vlr_scene* scene, const vlr_model* model, uint32_t neighbors,
                                                uint32_t* material);
/* How wide, in metres, a tile of the material's shell (VOTF) is, which scales its height; 0: as the texture coordinates
 * say, on average over each instance. Only of materials with a shell. */
VLR_API vlr_status vlr_scene_set_shell_tile(vlr_scene* scene, uint32_t material, float metres);
/* Over what share of the tile's width the edge of the material's shell (VOTF) fades out, from 0 (hard) to below 1: each
 * ray finds it elsewhere. */
VLR_API vlr_status vlr_scene_set_shell_softness(vlr_scene* scene, uint32_t material, float widths);
/* What the material reflects is multiplied with `gain`: red, green, blue of the working space, finite and at least 0;
 * (1, 1, 1) unless told. What glows, and what is let through, stays. Samples are drawn as before. */
VLR_API vlr_status vlr_scene_set_gain(vlr_scene* scene, uint32_t material, const float gain[3]);
/* Which rays (VLR_HIDDEN_FROM_CAMERA, _BOUNCES, _SHADOWS) pass through the material's back, the side that the mesh's
 * normal does not point to: light that falls on it, where shadows are concerned. 0, unless told: none. A shell has no
 * such side. */
VLR_API vlr_status vlr_scene_hide_backs(vlr_scene* scene, uint32_t material, uint32_t hidden_from);
/* Whether rays are drawn to the material's surfaces where they glow, as to a lamp (not 0; the default). 0: their light
 * is found by the directions that surfaces reflect, alone. The picture converges to the same. */
VLR_API vlr_status vlr_scene_set_drawn_to(vlr_scene* scene, uint32_t material, int32_t drawn);
/* Puts a model in the place of material number `material`, of whatever kind it was; a shell keeps tile and softness,
 * the gain stays. A committed scene stays committed, unless one of the two has a shell and the other none of the same
 * heights, or the model alone is anisotropic; no job of the scene may run meanwhile. */
VLR_API vlr_status vlr_scene_set_model_material(vlr_scene* scene, uint32_t material, const vlr_model* model,
                                                uint32_t neighbors);
/* Reference mode: f comes from the raw measurement. `proposal` (may be NULL) is the model whose lobes draw samples;
 * without one a coarse model is fitted here, which takes about a second. */
VLR_API vlr_status vlr_scene_add_measurement_material(vlr_scene* scene, const vlr_measurement* measurement,
                                                      const vlr_model* proposal, uint32_t neighbors,
                                                      uint32_t* material);
/* Reference mode of BTFs: f is that of the BTF itself, barycentric between its directions, linear between texels and
 * mip levels. All of it is read into memory as half floats; VLR_UNSUPPORTED where that takes more than `most_bytes` (0:
 * 4 GiB) or pairs are missing. Texture coordinates count tiles. Samples are drawn by the cosine. */
VLR_API vlr_status vlr_scene_add_btf_material(vlr_scene* scene, const vlr_btf* btf, uint64_t most_bytes,
                                              uint32_t* material);
/* Whose Principled BSDF: that of Blender 4.0 and newer, layers that give on what they do not reflect; or Disney's, of
 * Blender before 4.0. The equations are in docs/equations.md. */
enum { VLR_PRINCIPLED_LAYERED = 0, VLR_PRINCIPLED_DISNEY = 1 };
/* How GGX's facets shadow each other. */
enum {
  VLR_GGX_WHOLE = 0,    /* height-correlated, and light between facets is kept: Blender's Multiscatter GGX since 4.0 */
  VLR_GGX_SINGLE = 1,   /* height-correlated: GGX since Blender 3.5 */
  VLR_GGX_SEPARABLE = 2 /* both directions as if by themselves: GGX before Blender 3.5 */
};
typedef struct vlr_principled_desc {
  uint32_t struct_size;
  float base_color[3]; /* working space */
  float metallic;      /* 0..1 */
  float roughness;     /* 0..1, Principled's: alpha = roughness^2 */
  float specular;      /* 0..11.25: reflectance at normal incidence / 0.08; 0.5 = index 1.5 */
  float emission[3];   /* radiance, working space */
  float alpha;         /* 0..1: the share of the surface that is there; rays pass the rest */
  int32_t formula;     /* VLR_PRINCIPLED_* */
  int32_t lobe;        /* VLR_GGX_* */
  /* Of dielectrics at normal incidence, not negative; of metals near 82 degrees, 0..1 (VLR_PRINCIPLED_LAYERED). White.
   */
  float specular_tint[3];
  /* A dielectric layer on top, which a normal map does not turn (VLR_PRINCIPLED_LAYERED). */
  float coat;           /* 0..1: its weight */
  float coat_roughness; /* 0..1: 0.03 */
  float coat_index;     /* at least 1: 1.5 */
  float coat_tint[3];   /* not negative: what it lets through straight down and back; white */
  int32_t coat_lobe;    /* VLR_GGX_WHOLE since Blender 4.5; VLR_GGX_SINGLE: 4.0 to 4.4, which dim what is below as a
                           smooth coat does */
} vlr_principled_desc;
VLR_API void vlr_principled_desc_init(vlr_principled_desc* desc);
VLR_API vlr_status vlr_scene_add_principled_material(vlr_scene* scene, const vlr_principled_desc* desc,
                                                     uint32_t* material);

/* object_to_world [12]: 3 x 4 row-major. materials [count]: material of each slot of the mesh. */
VLR_API vlr_status vlr_scene_add_instance(vlr_scene* scene, uint32_t mesh, const float* object_to_world,
                                          const uint32_t* materials, uint32_t count);
/* The same with placements [count x 6]: of each slot a map [2 x 3, row-major] that takes (u, v, 1) of the mesh to the
 * texture coordinates that its material is shown with, as if the mesh had those; footprints, and the tangent that
 * anisotropy follows, come with them. An anisotropic BRDF is turned as the map turns, by angles on the surface, however
 * far texture coordinates are stretched there. NULL: they are the mesh's own. */
VLR_API vlr_status vlr_scene_add_placed_instance(vlr_scene* scene, uint32_t mesh, const float* object_to_world,
                                                 const uint32_t* materials, const float* placements, uint32_t count);
/* Many that differ in nothing but their meshes [instances] and matrices, object_to_world [instances x 12]. Those before
 * one that is refused have been added. */
VLR_API vlr_status vlr_scene_add_instances(vlr_scene* scene, const uint32_t* meshes, const float* object_to_world,
                                           uint64_t instances, const uint32_t* materials, uint32_t count);

/* Takes all of them out of the scene; meshes and materials stay. */
VLR_API vlr_status vlr_scene_clear_instances(vlr_scene* scene);

/* Bits: what passes through an instance as if it were not there; of a holdout the camera sees nothing, and nothing
 * behind it: black, alpha 0. */
enum { VLR_HIDDEN_FROM_CAMERA = 1, VLR_HIDDEN_FROM_BOUNCES = 2, VLR_HIDDEN_FROM_SHADOWS = 4, VLR_HOLDOUT = 8 };
/* Of all instances that are added from here on; 0, as at first: of none. */
VLR_API vlr_status vlr_scene_hide_instances(vlr_scene* scene, uint32_t hidden_from);
/* Shadow terminator of all instances that are added from here on: where light comes in at a cosine below `offset` (0 to
 * 1), shadow rays begin on the smooth surface that the shading normals belong to, so that coarse meshes show no steps.
 * Cycles' default is 0.1; 0, as at first: they begin on the mesh. */
VLR_API vlr_status vlr_scene_soften_terminator(vlr_scene* scene, float offset);

enum { VLR_LIGHT_SUN = 0, VLR_LIGHT_POINT = 1, VLR_LIGHT_RECTANGLE = 2, VLR_LIGHT_DISK = 3, VLR_LIGHT_SPOT = 4 };
typedef struct vlr_light_desc {
  uint32_t struct_size;
  int32_t type;   /* VLR_LIGHT_* */
  float color[3]; /* working space. Sun: irradiance on a facing plane, W/m^2. Others: power, W; of a spot: were its cone
                     a sphere */
  float light_to_world[12]; /* 3 x 4 row-major; the light shines along its -z */
  float size[2];            /* point, spot: radius, -; rectangle: sides; disk: diameters (an ellipse if they differ) */
  float angle;              /* sun: angular diameter; spot: of its cone; radians */
  int32_t casts_shadow;
  float blend;         /* spot: share of the cone over which its light fades out, 0..1; 0 */
  float spread;        /* rectangle, disk: full angle in which it shines, radians; pi: the same radiance everywhere */
  int32_t sphere;      /* point, spot: 1: a ball; 0: a disk that faces each place it lights, as Cycles' soft falloff */
  int32_t cosine;      /* spot: 1: its light also falls with the cosine to the axis, as in Blender before 3.5 */
  float cone_scale[2]; /* spot: its cone is so much wider along its x and y, as if space were stretched; 1, 1 */
} vlr_light_desc;
VLR_API void vlr_light_desc_init(vlr_light_desc* desc);
VLR_API vlr_status vlr_scene_add_light(vlr_scene* scene, const vlr_light_desc* desc);
VLR_API vlr_status vlr_scene_clear_lights(vlr_scene* scene);

/* How a picture file is read (vlr_picture_read). */
typedef struct vlr_picture_options {
  uint32_t struct_size;
  int32_t
      as_stored; /* 1: pixels as Blender shows them, without the header's orientation, exposure, primaries, windows */
  const char*
      layer; /* of an OpenEXR file: name of a layer, of a part or of one channel; NULL or "": the picture itself */
} vlr_picture_options;
VLR_API void vlr_picture_options_init(vlr_picture_options* options);

/* The world is +z up. Image: equirectangular, row 0 at the top (+z), in the convention of Blender: the middle column
 * looks along +x; u = 1/2 - atan2(y, x) / (2 pi) from the left, v = 1/2 + asin(z) / pi from the bottom.
 * world_to_image [9, row-major] turns a world direction before that look-up (NULL: identity). */
VLR_API vlr_status vlr_scene_set_world_color(vlr_scene* scene, const float* color);
VLR_API vlr_status vlr_scene_set_world_pixels(vlr_scene* scene, uint32_t width, uint32_t height, uint32_t channels,
                                              const float* pixels, float strength, const float* world_to_image);
VLR_API vlr_status vlr_scene_load_world(vlr_scene* scene, const char* path, float strength,
                                        const float* world_to_image);
/* The same with options (vlr_picture_read). What was left out of the file or replaced is among the warnings of
 * vlr_scene_info_json. */
VLR_API vlr_status vlr_scene_load_world_picture(vlr_scene* scene, const char* path, const vlr_picture_options* options,
                                                float strength, const float* world_to_image);
/* The image that is there, lit and turned anew: it is not read again. Refused where the world is a colour. */
VLR_API vlr_status vlr_scene_place_world(vlr_scene* scene, float strength, const float* world_to_image);

enum { VLR_CAMERA_PERSPECTIVE = 0, VLR_CAMERA_ORTHOGRAPHIC = 1 };
typedef struct vlr_camera_desc {
  uint32_t struct_size;
  int32_t type;              /* VLR_CAMERA_* */
  float camera_to_world[12]; /* 3 x 4 row-major; looks along its -z, +y up */
  float window[4];           /* left, right, bottom, top of the picture: at distance 1 (perspective) or in metres */
  float clip_start, clip_end;
  float aperture;       /* radius of a thin lens, metres; 0: all is sharp */
  float focus;          /* metres along -z to the plane that is sharp; 1 */
  uint32_t blades;      /* sides of the aperture, whose corners lie on the circle; below 3: the circle; 0 */
  float blade_rotation; /* of that polygon, counter-clockwise as the camera sees it, radians */
  float aperture_ratio; /* height over width of the aperture; 1 */
} vlr_camera_desc;
VLR_API void vlr_camera_desc_init(vlr_camera_desc* desc);
VLR_API vlr_status vlr_scene_set_camera(vlr_scene* scene, const vlr_camera_desc* desc);
/* Perspective camera from a point to a point; fov is the vertical angle of view. Up is +z. */
VLR_API vlr_status vlr_scene_look_at(vlr_scene* scene, const float* eye, const float* target, float fov, float aspect);
/* The default camera: frames the bounding box of all instances to the picture's height. `up_axis` 1 or 2 (y or z). */
VLR_API vlr_status vlr_scene_frame_camera(vlr_scene* scene, float aspect, uint32_t up_axis);

/* Builds the acceleration structure and checks the scene. Needed before a render job is made, after every change; what
 * has not changed is not built again: a camera, a light, a world or a plain material costs next to nothing, an instance
 * the level of the instances, a mesh that mesh. */
VLR_API vlr_status vlr_scene_commit(vlr_scene* scene);
/* Says before the first commit that no mesh and no instance changes after it: rays take less time. The last bits of a
 * picture differ from those of a scene that may change. */
VLR_API vlr_status vlr_scene_stay(vlr_scene* scene);
/* JSON: triangles, instances, lights, materials, untextured (instances of a mesh without texture coordinates whose
 * material varies over the surface: one place of it is shown everywhere), camera_inside (of a committed scene, the
 * number of the instance that the camera is inside of and sees nothing but; null), bytes, bvh_seconds, warnings. */
VLR_API vlr_status vlr_scene_info_json(vlr_scene* scene, const char** json);

/* ---- textures ------------------------------------------------------------------------------------------------ */

enum { VLR_WRAP_REPEAT = 0, VLR_WRAP_EXTEND = 1, VLR_WRAP_CLIP = 2, VLR_WRAP_MIRROR = 3 };
enum { VLR_FILTER_CLOSEST = 0, VLR_FILTER_LINEAR = 1 };

typedef struct vlr_texture_options {
  uint32_t struct_size;
  int32_t wrap;    /* VLR_WRAP_*: beyond the picture it is repeated, its border goes on, it is 0, it is mirrored */
  int32_t filter;  /* VLR_FILTER_*: between texels that are seen large; small ones are averaged either way */
  int32_t channel; /* -1: a colour, of the first three channels (of one or two: the first); else this one, a number */
  int32_t raw;     /* vlr_texture_load: 1: integer values are numbers from 0 to 1; 0: they are sRGB colours */
} vlr_texture_options;
VLR_API void vlr_texture_options_init(vlr_texture_options* options);
/* Texture coordinates (0, 0) are the lower left corner of the picture, (1, 1) the upper right. `pixels` [height x width
 * x channels], row 0 at the bottom: linear, colors in the working space; they are copied. NaN counts as 0, infinity as
 * the largest finite value. */
VLR_API vlr_status vlr_texture_create(uint32_t width, uint32_t height, uint32_t channels, const float* pixels,
                                      const vlr_texture_options* options, vlr_texture** out);
/* From an image file, whose colours are taken as they are, whatever the working space. */
VLR_API vlr_status vlr_texture_load(const char* path, const vlr_texture_options* options, vlr_texture** out);
/* The colours of the mesh's own corners, interpolated, in the place of a picture: of this set, below
 * VLR_MOST_COLOR_SETS; black on meshes that do not have it. It stands for a colour, or by its first channel for a
 * number; maps and sets of texture coordinates are not looked at. */
VLR_API vlr_status vlr_texture_of_corners(uint32_t set, vlr_texture** out);
VLR_API void vlr_texture_free(vlr_texture* texture);

/* Each may be NULL: the number of the vlr_principled_desc holds. A map [2 x 3, row-major] takes (u, v, 1) of the
 * surface to the picture's coordinates. */
typedef struct vlr_principled_textures {
  uint32_t struct_size;
  uint32_t pad;
  const vlr_texture* base_color; /* a colour */
  const vlr_texture* metallic;   /* numbers: these three */
  const vlr_texture* roughness;
  const vlr_texture* alpha;
  float base_color_map[6];
  float metallic_map[6];
  float roughness_map[6];
  float alpha_map[6];
  uint32_t base_color_set; /* of the mesh's texture coordinates; 0. One that a mesh does not have is its first. */
  uint32_t metallic_set;
  uint32_t roughness_set;
  uint32_t alpha_set;
} vlr_principled_textures;
VLR_API void vlr_principled_textures_init(vlr_principled_textures* textures);
VLR_API vlr_status vlr_scene_add_textured_material(vlr_scene* scene, const vlr_principled_desc* desc,
                                                   const vlr_principled_textures* textures, uint32_t* material);

/* ---- shaders: materials that are mixed of others -------------------------------------------------------------- */

enum {
  VLR_LAYER_PRINCIPLED = 0,
  VLR_LAYER_DIFFUSE = 1,     /* base_color and roughness: Oren and Nayar's; 0 is Lambert's */
  VLR_LAYER_GLOSSY = 2,      /* base_color, roughness and lobe: GGX that reflects it at every angle */
  VLR_LAYER_TRANSPARENT = 3, /* base_color: what light that goes straight on is multiplied with */
  VLR_LAYER_EMISSION = 4     /* base_color: radiance */
};
/* A weight is the product of its layer's factors. Of a mix, SHARE is its factor, REST 1 minus that, both within [0, 1];
 * GAIN is any number that is not negative. */
enum { VLR_FACTOR_SHARE = 0, VLR_FACTOR_REST = 1, VLR_FACTOR_GAIN = 2 };

/* What keeps steep mapped normals from showing what cannot be there. */
enum {
  /* Normals are turned as far as mirror images need to stay above the surface, and diffuse light fades out before the
   * surface's own horizon, as in Cycles of Blender 3 */
  VLR_RELIEF_TURNED = 0,
  VLR_RELIEF_FADED = 1,    /* the same, but normals of what is diffuse stay; Blender 4 */
  VLR_RELIEF_SHADOWED = 2, /* the same, but diffuse light fades out as facets of GGX shadow each other; Blender 5 */
  VLR_RELIEF_AS_IT_IS = 3  /* normals and light stay */
};

typedef struct vlr_layer_desc {
  uint32_t struct_size;
  int32_t kind;                            /* VLR_LAYER_* */
  const vlr_principled_desc* surface;      /* NULL: its defaults; alpha and emission are not looked at */
  const vlr_principled_textures* textures; /* NULL: none; of what the kind looks at */
  const vlr_texture* normal; /* what reflects: a normal map, colours; NULL: none. It follows the MikkTSpace tangents of
                                the mesh's relief_uvs */
  float normal_map[6];       /* as those of vlr_principled_textures */
  float normal_strength;     /* of its tilt, not negative; 1 */
  uint32_t normal_set;       /* as those of vlr_principled_textures */
  int32_t normal_correction; /* VLR_RELIEF_* */
  int32_t interreflection;   /* of a diffuse layer: its facets send light to each other, so energy is kept; 0 */
} vlr_layer_desc;
VLR_API void vlr_layer_desc_init(vlr_layer_desc* desc);
typedef struct vlr_factor_desc {
  uint32_t struct_size;
  int32_t kind;               /* VLR_FACTOR_* */
  float value;                /* 1 */
  uint32_t set;               /* as those of vlr_principled_textures */
  const vlr_texture* texture; /* numbers, in the place of value; NULL: none */
  float map[6];               /* as those of vlr_principled_textures */
} vlr_factor_desc;
VLR_API void vlr_factor_desc_init(vlr_factor_desc* desc);

/* The sum of its layers: mixes are layers whose weights add up to 1. */
VLR_API vlr_status vlr_shader_create(vlr_shader** out);
VLR_API void vlr_shader_free(vlr_shader* shader);
/* With a weight of 1. */
VLR_API vlr_status vlr_shader_add_layer(vlr_shader* shader, const vlr_layer_desc* desc);
/* Multiplies the weight of the layer that was added last. */
VLR_API vlr_status vlr_shader_weigh_layer(vlr_shader* shader, const vlr_factor_desc* desc);
/* A material of the layers so far; the shader may go, or grow. */
VLR_API vlr_status vlr_scene_add_shader_material(vlr_scene* scene, const vlr_shader* shader, uint32_t* material);

/* ---- tiles: procedural mesostructure ------------------------------------------------------------------------- */

/* One period of a small structure, repeated without end in x and y: plain weave, twill, net, chain mail, gravel,
 * corduroy. The cell is [0, period x] x [0, period y], metres, +z up. What crosses its border is there once, whole,
 * and sticks out; copies moved by the period complete it. The same options give the same arrays.
 *
 * The pitch, size / count, is the distance of neighbouring yarns, cords, rings, wales; or, about, of pebbles. */
typedef struct vlr_tile_options {
  uint32_t struct_size;
  uint32_t count;      /* pitches along a side of the cell; 0: the kind's own, as everywhere below */
  const char* kind;    /* of vlr_tile_kinds_json; "weave" */
  double size;         /* side of the cell, metres; negative: the kind's own, as everywhere below */
  double thickness;    /* pitches: height of a yarn, cord or rib, diameter of a wire, depth of a bed of gravel */
  double gap;          /* pitches: between neighbouring yarns, cords or ribs; kinds without a gap take none but 0 */
  double irregularity; /* 0..1: how far things shrink, here and there, from their ideal shape */
  uint32_t resolution; /* points around a yarn, wire, pebble or rib; even. Triangles grow with its square */
  uint32_t pad;
  uint64_t seed;
} vlr_tile_options;
VLR_API void vlr_tile_options_init(vlr_tile_options* options);
/* JSON: kinds [{name, summary, defaults {size, count, resolution, thickness, gap, irregularity}}], in the order in
 * which to show them; a kind has no default of what it does not take. The text belongs to the library. */
VLR_API vlr_status vlr_tile_kinds_json(const char** json);
VLR_API vlr_status vlr_tile_create(const vlr_tile_options* options, vlr_tile** out);
VLR_API void vlr_tile_free(vlr_tile* tile);
/* The mesh, with normals, texture coordinates and slots, ready for vlr_scene_add_mesh; the arrays belong to the handle.
 * Set desc->struct_size before. */
VLR_API vlr_status vlr_tile_desc(const vlr_tile* tile, vlr_mesh_desc* desc);
/* The material that slot `slot` has by default. Colours are linear Rec. 709. Set material->struct_size before. */
VLR_API vlr_status vlr_tile_material(const vlr_tile* tile, uint32_t slot, vlr_principled_desc* material);
/* JSON: kind, period [x, y] (metres), heights [lowest, highest] (metres), open (a vertical line through it may meet
 * nothing), open_area (share of such lines; null: not known in closed form), vertices, triangles, shape (the keys of
 * defaults, and seed), materials [{name, base_color, metallic, roughness, specular}], one a slot. */
VLR_API vlr_status vlr_tile_info_json(vlr_tile* tile, const char** json);

/* ---- capture of tiles ---------------------------------------------------------------------------------------- */

enum { VLR_SIDES_AUTOMATIC = 0, VLR_SIDES_ONE = 1, VLR_SIDES_TWO = 2 };

/* Directions are pairs (theta, phi) in degrees: theta from the normal of the reference plane, beyond 90 below it. */
typedef struct vlr_capture_options {
  uint32_t struct_size;
  uint32_t texels[2]; /* along x and y */
  uint32_t samples;   /* paths a texel and view */
  uint32_t bounces;   /* further surfaces a path meets */
  int32_t sides;      /* VLR_SIDES_*: two adds the mirror images of all directions; automatic: of an open tile */
  uint32_t threads;   /* 0: all */
  int32_t resume;     /* 1: go on with the views that the folder holds of this very capture */
  uint64_t seed;
  const double* views;  /* [view_count x 2]; NULL: the library's 105, rings to 85 degrees */
  const double* lights; /* [light_count x 2]; NULL: the same */
  uint64_t view_count, light_count;
  double origin[2];        /* of the cell, in the scene's units */
  double period[2];        /* both 0: the bounding box of the geometry, its origin included */
  double metres_per_unit;  /* 0: not known */
  double reference_height; /* scene's z of the reference plane; NaN: chosen by least variance over views */
  uint64_t memory_limit;   /* bytes that the images of a view may hold; beyond it they lie in a file in the folder */
  const char* source;      /* name of what is captured */
  int32_t measure_ray_share;
  uint32_t held_out; /* not 0: so many pairs to judge models by, up to 75 degrees, in place of views and lights */
} vlr_capture_options;
VLR_API void vlr_capture_options_init(vlr_capture_options* options);
/* Angles of a set: [*count x 2] degrees. `name`: "81" (Bonn's), "105" (the same and a ring at 85 degrees), or another
 * number of directions of equal solid angle. First reads the count (angles NULL). */
VLR_API vlr_status vlr_directions(const char* name, double* angles, uint64_t* count);
/* Captures the committed scene `tile`, repeated by the period, into the folder `path`. JSON: seconds, rays,
 * rays_per_second, ray_share (or null), bytes, views, lights, pairs, views_resumed, sides, open, thickness,
 * reference_height (metres, or widths of the tile, over its lowest point), warnings. The scene must not change while
 * the job is there. */
VLR_API vlr_status vlr_capture_create_job(const vlr_scene* tile, const vlr_capture_options* options, const char* path,
                                          vlr_job** out);

/* ---- occlusion of tiles (VOTF) --------------------------------------------------------------------------------- */

typedef struct vlr_votf_options {
  uint32_t struct_size;
  uint32_t texels;         /* along x; y and the height are as fine */
  uint32_t threads;        /* 0: all */
  uint32_t check_views;    /* random views up to 75 degrees that the result is compared with rays under; 0: none */
  uint64_t seed;           /* of those */
  double origin[2];        /* of the cell, in the scene's units */
  double period[2];        /* both 0: the bounding box of the geometry, its origin included */
  double metres_per_unit;  /* 0: not known */
  double surface;          /* scene's z that lies on the surfaces which will carry the structure */
  double reference_height; /* scene's z of the plane of a BTF's texels; NaN: as vlr_capture_options chooses it */
  const char* source;      /* name of what is captured */
} vlr_votf_options;
VLR_API void vlr_votf_options_init(vlr_votf_options* options);
/* Adds to a copy of `model` what the committed scene `tile`, repeated by the period, lets rays through: surfaces with
 * the result show its outline and its holes. What `model` had of it is replaced. The result is a
 * model. JSON: seconds, bytes, texels, points [x, y, z], heights [lowest, highest] (widths of the tile), closed,
 * coverage, wrong (both null without check_views), warnings. The scene must not change while the job is there. */
VLR_API vlr_status vlr_votf_create_job(const vlr_scene* tile, const vlr_model* model, const vlr_votf_options* options,
                                       vlr_job** out);
/* The same from what the views of a BTF show, without the geometry: coverage and heights of a capture, or the alpha of
 * pictures. Of `options` texels (0: those of the data), threads, check_views (of the data's own, evenly spread; `wrong`
 * is the mean difference of coverage there), surface (its height over the structure's lowest point, metres, or widths
 * of the tile where its size is not known) and source count. Fails with VLR_UNSUPPORTED where the data do not say what
 * the structure covers. */
VLR_API vlr_status vlr_votf_data_create_job(const vlr_btf* btf, const vlr_model* model, const vlr_votf_options* options,
                                            vlr_job** out);

/* ---- render -------------------------------------------------------------------------------------------------- */

enum {
  VLR_STRATEGY_UNIFORM = 0,
  VLR_STRATEGY_COSINE = 1,
  VLR_STRATEGY_TABLE = 2,
  VLR_STRATEGY_SRBF = 3,
  VLR_STRATEGY_LIGHT = 4,
  VLR_STRATEGY_MIS = 5,
  VLR_STRATEGY_GGX = 6,     /* a GGX lobe over a diffuse base, fitted to each material when the render starts */
  VLR_STRATEGY_MIS_GGX = 7, /* half from that lobe, half from the lights */
  VLR_STRATEGY_PRODUCT = 8, /* lobes of the material times lobes of the environment, beside both */
  /* The dissertation's: of scattered models the interpolated densities of the nearest views (`neighbors`, or 4), of
   * others as SRBF; independent numbers, whatever `sequence` says. MIS: half of the directions from the lights. */
  VLR_STRATEGY_DISSERTATION = 9,
  VLR_STRATEGY_MIS_DISSERTATION = 10
};

enum { VLR_HEURISTIC_BALANCE = 0, VLR_HEURISTIC_POWER = 1 };
enum { VLR_SEQUENCE_RANDOM = 0, VLR_SEQUENCE_SOBOL = 1, VLR_SEQUENCE_INDEPENDENT = 2 };

/* Bits: passes beyond "Combined", "Depth", "Normal" and "Sample Count", which every picture has. */
enum {
  VLR_PASS_POSITION = 1,       /* "Position" 3: world; of a pixel's first camera ray, as depth is */
  VLR_PASS_UV = 2,             /* "UV" 3: means; the third is the share of the pixel that has texture coordinates */
  VLR_PASS_OBJECT_INDEX = 4,   /* "IndexOB" 1: of the first camera ray */
  VLR_PASS_MATERIAL_INDEX = 8, /* "IndexMA" 1: the same */
  VLR_PASS_MIST = 16,          /* "Mist" 1: 0..1, mean */
  VLR_PASS_ALBEDO = 32, /* "Albedo" 3: share of light that is reflected to the viewer, 0..1, working space, mean */
  VLR_PASS_ERROR = 64,  /* "Error" 3: standard error of "Combined", as if camera rays were independent */
  VLR_PASS_CRYPTO_OBJECT =
      128, /* "CryptoObject00", "CryptoObject01", ... 4: two ids, each with its coverage behind it */
  VLR_PASS_CRYPTO_MATERIAL = 256, /* "CryptoMaterial00", ...: the same */
  VLR_PASS_CRYPTO_ASSET = 512,    /* "CryptoAsset00", ...: the same */
  VLR_PASS_DENOISING_ALBEDO =
      1024, /* "Denoising Albedo" 3: albedo, and what surfaces and the sky shine by themselves; above 1 where they do */
  VLR_PASS_HALVES = 2048 /* "Halves" 18: of the even camera rays color, denoising albedo and normal, 3 each; of the odd
                            ones the same; means */
};

typedef struct vlr_instance_label {
  float index;     /* "IndexOB" */
  float object_id; /* of vlr_cryptomatte_id; 0: none */
  float asset_id;
  int32_t uv_set; /* of the mesh's sets of texture coordinates the one that "UV" shows; -1: none */
} vlr_instance_label;
typedef struct vlr_material_label {
  float index; /* "IndexMA" */
  float id;    /* of vlr_cryptomatte_id; 0: none */
} vlr_material_label;

typedef struct vlr_pass_options {
  uint32_t struct_size;
  uint32_t asked;             /* VLR_PASS_* */
  uint32_t cryptomatte_ranks; /* ids that a pixel tells, two a pass; 2..16; 6 */
  float mist_start;           /* metres from the camera; 5 */
  float mist_depth;           /* metres from there to where all is mist; 0: there is none; 25 */
  float mist_exponent;        /* of the share of that way: 1 linear, 2 quadratic, 0.5 inverse quadratic; 2 */
  /* By the numbers of the scene's instances and materials; those beyond have no index, id or texture coordinates. */
  const vlr_instance_label* instances;
  uint64_t instance_count;
  const vlr_material_label* materials;
  uint64_t material_count;
} vlr_pass_options;
VLR_API void vlr_pass_options_init(vlr_pass_options* options);
/* Of a UTF-8 name: MurmurHash3_x86_32 with seed 0, and its bits as the float that the Cryptomatte specification makes
 * of them. NULL: not wanted. */
VLR_API vlr_status vlr_cryptomatte_id(const char* name, uint32_t* hash, float* id);

typedef struct vlr_render_options {
  uint32_t struct_size;
  uint32_t width, height;
  uint32_t spp;     /* light directions a pixel */
  uint32_t split;   /* of them, how many share one camera ray; 1..48; 8 */
  uint32_t bounces; /* indirect bounces; 0: direct illumination only */
  int32_t strategy; /* VLR_STRATEGY_* */
  uint32_t threads; /* 0: all */
  uint64_t seed;
  double time_limit;         /* seconds, 0: none; stops at a whole pass */
  int32_t transparent;       /* 1: rays that meet nothing leave alpha 0 */
  int32_t measure_ray_share; /* 1: record 1 tile in 16 and replay its rays */
  int32_t heuristic;         /* of VLR_STRATEGY_MIS, for the environment: VLR_HEURISTIC_* */
  int32_t sequence;          /* VLR_SEQUENCE_* */
  double share;              /* of VLR_STRATEGY_MIS: share of the directions that the lights draw; 0..1; 0.5 */
  double noise;              /* relative error at which a block of 16 x 16 pixels gets no more samples; 0: off */
  const char* cache_folder;  /* for fits of the environment (product), made when missing; NULL or "": none */
  int32_t hide_world;        /* 1: rays of the camera that meet nothing are black; `transparent` goes before */
  /* Parts of a picture, for several machines; they do not go with `noise`. Of the spp light directions of a pixel
   * [samples_begin, samples_end), 0: to the last; multiples of split, or spp. Means of ranges, weighted by their camera
   * rays (split light directions each, the last of a pixel what is left), are the picture but for rounding. */
  uint32_t samples_begin, samples_end;
  /* Pixels [x0, x1) x [y0, y1), row 0 at the bottom, of width x height; all 0: all. They have the bits that they have
   * in the whole picture, and passes hold them alone. */
  uint32_t crop_x0, crop_y0, crop_x1, crop_y1;
  /* Cycles' settings against fireflies, with its meaning. Each biases the picture, which neither noise nor block_noise
   * tells of. The largest mean of the channels of what one sample brings, of light that comes straight from emitters to
   * the first surface or the camera, and of all other; 0: none. */
  float clamp_direct, clamp_indirect;
  float filter_glossy;         /* roughens lobes that paths come to by directions of a density below it; 0: none */
  int32_t reflective_caustics; /* 0: no lobes of microfacets behind diffuse bounces; 1 */
  int32_t denoise; /* 1: the picture can be denoised (vlr_denoise_create_job), and `noise` is the error of the denoised
                      one, of the whole picture: the bound's root (relmse_bound there). The film has VLR_PASS_HALVES */
  const vlr_pass_options* passes; /* copied; NULL: none beyond those that every picture has */
} vlr_render_options;
VLR_API void vlr_render_options_init(vlr_render_options* options);
/* JSON: seconds, rays, samples_per_second, ray_share (or null), stages, nan_samples, spp, passes, noise, spp_mean,
 * block_noise, blocks_unfinished (null without a noise target), sky (null, or of VLR_STRATEGY_PRODUCT: lobes,
 * relative_l2, seconds, cached). */
VLR_API vlr_status vlr_render_create_job(const vlr_scene* scene, const vlr_render_options* options, vlr_job** out);

/* The film so far, row 0 at the bottom. Passes and channels: "Combined" 4 (RGBA, premultiplied), "Depth" 1,
 * "Normal" 3 (world), "Sample Count" 1, and those of VLR_PASS_* that were asked for. `pixels` holds width x height x
 * channels, of a crop its own width and height. May be called while the job runs. */
VLR_API vlr_status vlr_job_read_pass(const vlr_job* job, const char* pass, float* pixels, uint64_t count);

/* What a render's film has, as numbers that another one of the same size and passes can add: camera rays of a picture
 * (samples_begin, samples_end) that several runs or machines share out. Copies `count` = width x height x per_pixel
 * floats to `sums` unless it is NULL, and tells per_pixel unless that is. While the job runs, tiles are as far as they
 * are. */
VLR_API vlr_status vlr_job_read_sums(const vlr_job* job, float* sums, uint64_t count, uint32_t* per_pixel);
/* Adds such sums of camera rays, those that come before of a job that is to be started, which then adds its own; or
 * those that come after, once it is done. Not while it runs. Once it has both such sums and camera rays of its own,
 * which a new run would count twice, vlr_job_start refuses with VLR_INVALID_STATE. */
VLR_API vlr_status vlr_job_add_sums(vlr_job* job, const float* sums, uint64_t count);

/* Takes the noise out of the picture of a render whose options said `denoise`, and which does not run: then
 * vlr_job_read_pass of that render has "Denoised" 4 (RGBA, premultiplied; the alpha of "Combined"), until it gets more
 * samples. `threads` 0: all. JSON: relmse, relmse_bound (estimate of the denoised picture's error, and a bound that the
 * true one stays below in 95 of 100 pictures; null where a pixel has less than two camera rays: docs/rendering.md),
 * noisy_share (0..1, of the noisy picture in it), path of Open Image Denoise. VLR_UNSUPPORTED where that is
 * missing. */
VLR_API vlr_status vlr_denoise_create_job(vlr_job* render, uint32_t threads, vlr_job** out);
/* JSON: version and path of Open Image Denoise; opens it. VLR_UNSUPPORTED, with what was tried, where it is missing. */
VLR_API vlr_status vlr_denoiser_json(const char** json);
/* The file of Open Image Denoise 2 that is tried before libOpenImageDenoise.so.2 beside this library and on the
 * system's path; NULL or "": none. Without effect once one is open. */
VLR_API vlr_status vlr_set_denoiser_file(const char* path);

/* Asks a render to end at a whole pass, soon, with what it has: then it is done, and its report's spp says how many
 * light directions every pixel has. From any thread; a job that starts again does not know of it any more. */
VLR_API vlr_status vlr_job_stop(vlr_job* job);

/* A picture for somebody who watches: coarse at once, then finer, then less noisy; `noise`, `time_limit`, samples,
 * crop and passes are not used. Started again after a cancel, the job goes on where it was. The scene may change while
 * it does not run: then vlr_progressive_restart comes before the next start. The job commits the scene. No report but
 * {}. */
VLR_API vlr_status vlr_progressive_create_job(vlr_scene* scene, const vlr_render_options* options, vlr_job** out);
/* The next start begins anew. Not while the job runs. */
VLR_API vlr_status vlr_progressive_restart(vlr_job* job);
typedef struct vlr_progressive_picture {
  uint32_t struct_size;
  uint32_t width, height; /* 0: there is none yet */
  uint32_t samples;       /* light directions that every pixel of full size has */
  uint64_t version;       /* grows with what there is to see */
} vlr_progressive_picture;
/* The picture so far, RGBA, premultiplied, row 0 at the bottom: width x height x 4 values of the picture, which has no
 * more than the options asked for. `count` values fit `pixels`; NULL: only `picture` is wanted. At any time. */
VLR_API vlr_status vlr_progressive_read(const vlr_job* job, float* pixels, uint64_t count,
                                        vlr_progressive_picture* picture);

/* ---- observations -------------------------------------------------------------------------------------------- */

/* Under which views and lights frames show a material, with weights, and 1024 of its hits with their light. Files are
 * JSON (docs/formats.md). An observation may be changed (merge) by one thread at a time. */

/* Of no frame: something to merge into. */
VLR_API vlr_status vlr_observation_create(vlr_observation** out);
VLR_API vlr_status vlr_observation_load(const char* path, vlr_observation** out);
/* Writes atomically. */
VLR_API vlr_status vlr_observation_save(const vlr_observation* observation, const char* path);
VLR_API void vlr_observation_free(vlr_observation* observation);
/* Adds what `other` saw to `into`. The result does not depend on the order of frames, but for the rounding of sums. */
VLR_API vlr_status vlr_observation_merge(vlr_observation* into, const vlr_observation* other);
/* JSON: kind "observation", frames, camera_rays, hits, weight (of all hits, in camera rays), share (weight /
 * camera_rays), views [from, to] (degrees that a model reduced to it covers; null when nothing was seen), light_density
 * (1/sr; null: light without extent), hash; of a material that varies over the surface also surface {finest (width of
 * the finest look-ups, as a share of the tile's side that has more texels), footprint [shares of the weight by that
 * width, an octave each from 2^-16 on], tile_share (how much of the tile was seen)}. */
VLR_API vlr_status vlr_observation_info_json(vlr_observation* observation, const char** json);

typedef struct vlr_observe_options {
  uint32_t struct_size;
  uint32_t width, height; /* of the picture: their ratio shapes the grid of about 65,536 camera rays,
                           * their number what of a varying material one stands for */
  uint32_t bounces;       /* as of the render */
  uint32_t threads;       /* 0: all */
  uint32_t pad;
  uint64_t seed;
} vlr_observe_options;
VLR_API void vlr_observe_options_init(vlr_observe_options* options);
/* Observes one material of a committed scene. Result: an observation of one frame. JSON: seconds, and the keys of
 * vlr_observation_info_json but kind. */
VLR_API vlr_status vlr_observe_create_job(const vlr_scene* scene, uint32_t material, const vlr_observe_options* options,
                                          vlr_job** out);
/* Share of the weight of the material in `frame` that lies outside of what a reduced model was made for: seen at other
 * views, or under more concentrated light; of a BTF, seen more finely than its finest texels. 0 for a model of any
 * scene. */
VLR_API vlr_status vlr_model_out_of_domain(const vlr_model* model, const vlr_observation* frame, double* share);
/* The observation of a finished job; a new handle. */
VLR_API vlr_status vlr_job_result_observation(const vlr_job* job, vlr_observation** out);

/* ---- tables for shaders --------------------------------------------------------------------------------------- */

/* The light of a scene's world as a shader looks it up (docs/realtime.md): averaged by the clipped cosine and by
 * Gaussian lobes, level by level, and the world itself. Of the world as it is when the job is made. cache_folder: as of
 * vlr_render_options. threads, here and below: 0: all. JSON: lobes, relative_l2, seconds and cached of the fit of the
 * world's mixture; mixture: of each lobe x, y, z, bandwidth, r, g, b. */
VLR_API vlr_status vlr_light_map_create_job(const vlr_scene* scene, const char* cache_folder, uint32_t threads,
                                            vlr_job** out);
/* The lobes of a model of a BRDF at many views, as a shader sums them up. JSON: isotropic, side, blends, lobes.
 * VLR_INVALID_ARGUMENT for models of BTFs. */
VLR_API vlr_status vlr_lobe_rows_create_job(const vlr_model* model, uint32_t threads, vlr_job** out);
/* The same of a Principled material, without emission and alpha. */
VLR_API vlr_status vlr_principled_rows_create_job(const vlr_principled_desc* desc, uint32_t threads, vlr_job** out);
/* A BTF of SRBFs as maps of its coefficients and relief: seen and lit from above, and, where the BTF has that, from
 * below; the table has the `layers` of each side, one above the other. JSON: levels (of each x, width, height in a
 * layer), sides (of each layers, terms (of each coefficient light, view, half, phase, in_tile, color), bottom, top),
 * aspect, root. VLR_INVALID_ARGUMENT for other models. */
VLR_API vlr_status vlr_btf_maps_create_job(const vlr_model* model, vlr_job** out);
/* The outline (VOTF) of a model as a volume; the table has `layers` of it, the lowest first, one above the other, with
 * a border of one pixel: distance to the structure in widths of the tile, and its slope along x, y, z. JSON: layers,
 * bottom, top, reference (heights in widths), aspect, reach (the longest distance that is told apart), open (whether
 * rays can go through). VLR_INVALID_ARGUMENT for models without outline, VLR_UNSUPPORTED
 * for more than 2^23 pixels. */
VLR_API vlr_status vlr_shell_maps_create_job(const vlr_model* model, vlr_job** out);

/* ---- plots of models ----------------------------------------------------------------------------------------- */

enum {
  VLR_PLOT_LOBES = 0,      /* luminance of f cos(theta_l) in the plane of incidence of one view, polar: the model, each
                            * of its lobes, and what was measured */
  VLR_PLOT_ORDER = 1,      /* error against lobes (BTFs: against bytes) with the point that was chosen */
  VLR_PLOT_VIEW_ERROR = 2, /* relative L2 at 5, 30, 60, 75 and 85 degrees, and the tolerance */
  VLR_PLOT_ALBEDO = 3,     /* directional albedo of each channel against the view angle: the model, what was measured */
  VLR_PLOT_OUTLINE = 4     /* share of the tile that its outline (VOTF) covers against the view angle: mean, least and
                            * most of the azimuths */
};
/* The numbers of a plot (VLR_PLOT_*). `measurement` adds those that only it has; NULL: none. `view` is the polar angle
 * of the view of VLR_PLOT_LOBES, 0 to below pi/2; `azimuth` its azimuth, and that of the views of VLR_PLOT_ALBEDO.
 * VLR_UNSUPPORTED with the reason where the model has no such plot: BTFs have VLR_PLOT_ORDER, any
 * model with an outline VLR_PLOT_OUTLINE. */
VLR_API vlr_status vlr_plot_create(const vlr_model* model, const vlr_measurement* measurement, int32_t kind,
                                   double view, double azimuth, vlr_plot** out);
/* The same in the background; vlr_job_result_plot gives it. JSON: as vlr_plot_json. Albedos take seconds. */
VLR_API vlr_status vlr_plot_create_job(const vlr_model* model, const vlr_measurement* measurement, int32_t kind,
                                       double view, double azimuth, vlr_job** out);
/* The plot of a finished job; a new handle. */
VLR_API vlr_status vlr_job_result_plot(const vlr_job* job, vlr_plot** out);
VLR_API void vlr_plot_free(vlr_plot* plot);
/* JSON: plot ("lobes", "order", "view-error", "albedo", "outline"), polar, x and y {column, label, logarithmic, range
 * [low, high]}, series [{name, x [..], y [..], chosen (the number of a point, or null)}]. Angles in degrees, f in 1/sr.
 */
VLR_API vlr_status vlr_plot_json(vlr_plot* plot, const char** json);

typedef struct vlr_plot_style {
  uint32_t struct_size;
  uint32_t side; /* pixels, 64..8192; 800 */
  float text;    /* em of the text, pixels, at most a sixteenth of the side; 0: by the side */
  /* sRGB as displays take it, 0..1. What would not be read on the background is moved towards the text. */
  float background[3];
  float foreground[3]; /* text and axes */
  float model[3];
  float measured[3]; /* and the chosen point */
  float red[3], green[3], blue[3];
} vlr_plot_style;
/* For white paper. */
VLR_API void vlr_plot_style_init(vlr_plot_style* style);
/* RGBA of side x side, row 0 at the bottom: sRGB, 0..1, opaque. `count` is 4 side^2. */
VLR_API vlr_status vlr_plot_draw(const vlr_plot* plot, const vlr_plot_style* style, float* rgba, uint64_t count);
/* By extension, atomically: .png and .svg are the same picture, .csv has the numbers (series, x, y, chosen). */
VLR_API vlr_status vlr_plot_save(const vlr_plot* plot, const vlr_plot_style* style, const char* path);

/* ---- images -------------------------------------------------------------------------------------------------- */

/* Writes linear pixels [height x width x channels], row 0 at the bottom, atomically. The extension picks the format:
 * .exr keeps floats, .png gets the sRGB curve and 8 bits. */
VLR_API vlr_status vlr_image_write(const char* path, uint32_t width, uint32_t height, uint32_t channels,
                                   const float* pixels);
/* First reads the size (pixels NULL), then the pixels, row 0 at the bottom: all channels of the first part of an
 * OpenEXR file as they are stored, colors first; of other files what vlr_picture_read reads. For files that Velour
 * wrote. */
VLR_API vlr_status vlr_image_read(const char* path, uint32_t* width, uint32_t* height, uint32_t* channels,
                                  float* pixels, uint64_t count);
/* The picture of an OpenEXR, Radiance HDR, PNG, JPEG, TIFF or BMP file that any program wrote, recognized by its
 * content: 1 to 4 channels (gray, gray and alpha, RGB, RGBA), upright, linear Rec. 709, row 0 at the bottom. First
 * reads the size (pixels NULL), then the pixels. +infinity becomes the largest finite value, NaN 0. */
VLR_API vlr_status vlr_picture_read(const char* path, const vlr_picture_options* options, uint32_t* width,
                                    uint32_t* height, uint32_t* channels, float* pixels, uint64_t count);
/* JSON list of sentences: what of the file is left out, and what its header says that is not followed. The text is this
 * thread's until its next call. */
VLR_API vlr_status vlr_picture_notes_json(const char* path, const vlr_picture_options* options, const char** json);
/* Where the pixels of an OpenEXR file lie in a larger picture (its data window in its display window). */
typedef struct vlr_image_frame {
  uint32_t struct_size;
  uint32_t width, height; /* of the larger picture */
  int32_t x, y;           /* of the lower left pixel, from the larger picture's lower left corner */
} vlr_image_frame;
/* As vlr_image_write, of .exr alone, with such a frame (NULL: a picture of its own) and texts in the header: `texts`
 * holds text_count names, each followed by its text. */
VLR_API vlr_status vlr_image_write_part(const char* path, uint32_t width, uint32_t height, uint32_t channels,
                                        const float* pixels, const vlr_image_frame* frame, const char* const* texts,
                                        uint32_t text_count);
/* What the header of an OpenEXR file says: width, height, channels [names, in the order of vlr_image_read], frame
 * {width, height, x, y}, texts {name: text}, multi_part (there are further parts, of which nothing is said). The text
 * is this thread's until its next call. */
VLR_API vlr_status vlr_image_header_json(const char* path, const char** json);
/* rmse and relmse of linear RGB: relmse = mean((x - r)^2 / (r^2 + 0.01 mean(r)^2)). Pixel counts must agree. */
VLR_API vlr_status vlr_image_compare(uint64_t pixel_count, uint32_t channels, const float* pixels,
                                     const float* reference, double* rmse, double* relmse);

#ifdef __cplusplus
}
#endif
#endif
