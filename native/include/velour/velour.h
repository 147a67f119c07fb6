/* Velour: measured materials. The only public header, in pure C99: a program needs no other file.
 *
 * Every call that can fail returns vlr_status; vlr_last_error() then holds one sentence for the user (file, field,
 * value, remedy), kept for the calling thread until its next failing call. Nothing here prints, exits or aborts.
 *
 * Handles are opaque. A handle keeps alive what it needs, so they may be freed in any order; freeing NULL is fine. A
 * handle may be used by one thread at a time, except that a vlr_job may be polled, cancelled and read from any thread.
 * Models and measurements are immutable and may be shared freely. Long calls keep alive the model, measurement, BTF or
 * observation that they read: once they have begun, another thread may free its handle.
 *
 * Options structs begin with their size: call the matching vlr_*_options_init() first, then change fields. Defaults
 * live in the library only; a number at the end of a field's comment is the field's default. Arrays are borrowed for
 * the call: float32, row-major, contiguous. Strings are UTF-8. A string returned through a `const char**` belongs to
 * the handle and is valid until the handle is freed or the same call is repeated.
 *
 * Directions are unit, point away from the surface, in the local shading frame: +z normal, +x tangent. wl points to the
 * light, wv to the viewer. f is the BRDF in 1/sr without the cosine, linear Rec. 709. Angles are in radians and
 * lengths in meters, unless a name says otherwise.
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

/* Increases whenever a struct or the meaning of a call changes. */
#define VLR_ABI_VERSION 13

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
typedef struct vlr_texture vlr_texture;         /* an image that replaces a parameter of a material */
typedef struct vlr_program vlr_program;         /* values computed at each point of a surface */
typedef struct vlr_shader vlr_shader;           /* the layers of a material under construction */
typedef struct vlr_observation vlr_observation; /* scene usage of one material */
typedef struct vlr_tile vlr_tile;               /* procedural mesostructure */
typedef struct vlr_plot vlr_plot;               /* data about a model, as numbers and as an image */
typedef struct vlr_job vlr_job;

/* ---- library ------------------------------------------------------------------------------------------------- */

/* Sentence of this thread's last failing call; "" before the first. */
VLR_API const char* vlr_last_error(void);
/* major * 10000 + minor * 100 + patch. */
VLR_API uint32_t vlr_version(void);
VLR_API uint32_t vlr_abi_version(void);
/* Checks that the ray tracer bound to this library is the one it was built for (version, one known ray hits).
 * vlr_scene_create does this first; call it at load time to detect problems early. */
VLR_API vlr_status vlr_self_test(void);
/* JSON: version, embree {version, path}, simd, simd_targets, threads, build_type. The text belongs to the library. */
VLR_API vlr_status vlr_system_json(const char** json);
/* Selects the instruction set of all kernels: "auto", or a name from simd_targets. Not while a job runs. */
VLR_API vlr_status vlr_select_simd(const char* target);

/* ---- measurements -------------------------------------------------------------------------------------------- */

/* Reads a measurement file; the format is recognized by its content. */
VLR_API vlr_status vlr_measurement_load(const char* path, vlr_measurement** out);
/* Reads a measurement in the background; vlr_job_result_measurement returns it. JSON: as vlr_measurement_info_json. A
 * cancel takes effect once the file is read. */
VLR_API vlr_status vlr_measurement_load_create_job(const char* path, vlr_job** out);
VLR_API void vlr_measurement_free(vlr_measurement* measurement);
/* JSON: kind "measurement", format, name, path, sha256, bytes, isotropic, entries {total, valid, negative, not_finite,
 * below_horizon, out_of_gamut}, details {...}. */
VLR_API vlr_status vlr_measurement_info_json(vlr_measurement* measurement, const char** json);
/* Evaluates f [count x 3] for one view wv [3] and `count` light directions wl [count x 3]; valid [count] is 1 where the
 * measurement covers them. */
VLR_API vlr_status vlr_measurement_eval(const vlr_measurement* measurement, const float* wv, uint64_t count,
                                        const float* wl, float* f, uint8_t* valid);

/* ---- models -------------------------------------------------------------------------------------------------- */

/* Reports on models, BTFs, scenes and captures contain warning_codes [{code, values {name: value}}]. The codes, the
 * names and the units of their values are in native/src/base/warning.h; a value is a number, a text, or a list of
 * either. Their sentences are in addon/velour/core/warning_table.py; the command line adds them as "warnings". */

VLR_API vlr_status vlr_model_load(const char* path, vlr_model** out);
/* Reads the bytes of a model file in memory (a packed image); `name` appears in error sentences. */
VLR_API vlr_status vlr_model_load_memory(const void* bytes, uint64_t size, const char* name, vlr_model** out);
VLR_API void vlr_model_free(vlr_model* model);
/* Writes atomically: the old file or the new one, never a part. */
VLR_API vlr_status vlr_model_save(const vlr_model* model, const char* path);
/* The bytes that vlr_model_save would write; they belong to the handle. */
VLR_API vlr_status vlr_model_bytes(vlr_model* model, const void** bytes, uint64_t* size);
/* Makes the model of a surface that is rougher by `roughness`, 0 to 1: a mirror gets about the highlight of a GGX or
 * Beckmann surface of alpha = roughness^2, and other highlights are widened by as much. Albedos are kept
 * (docs/engine/parametric_model.md). The result has its own samples and densities; 0 gives the same model.
 * VLR_INVALID_ARGUMENT for models of BTFs. */
VLR_API vlr_status vlr_model_roughened(const vlr_model* model, float roughness, vlr_model** out);
/* JSON: kind "model", model "scattered" (per-view) or "parametric", kernel, isotropic, lobes, bytes, parameter_bytes,
 * relative_l2, by_view_angle, albedo_by_view_angle, albedo_max, reciprocity, measured_reciprocity, tolerance, seed,
 * all_data, warning_codes, order (as of a fit), source {name, format, sha256}, narrowest_roughness (of a GGX highlight
 * about as narrow as the narrowest lobe that matters, 0 to 1). Per-view: also views, max_lobes_per_view. Parametric:
 * also cells, symmetric, view_range [from, to] in degrees, spaces {light, half}, the numbers of lobes in each. BTFs
 * (model "factored-btf", "srbf-btf" or "tensor-btf") have instead: method, psnr, psnr_held_out, ser, relative_l2, p99,
 * raw_bytes, seed, verdict, warning_codes, tolerance, order, search, shapes (as of a fit), texels, tile_metres, views,
 * lights, companding; components, or coefficients (of the side that has most) and, for SRBFs, lobes; and sides: view
 * and light
 * ("above", "below"), parameter_bytes, as (null, or the index of the side that serves this one, whose own fields are
 * null) and lobes {tile, texel}, or clusters, members, ranks {texel, view, light, color}, relief (whether there is
 * one), table_bytes and bytes of each part {coefficients, members, relief, factors, cores, scales}, which add up to
 * parameter_bytes. Also scene (as of a fit) for scene models, and shell for models with a VOTF. */
VLR_API vlr_status vlr_model_info_json(vlr_model* model, const char** json);
/* Like vlr_measurement_eval; also returns the density of the model's own sampler if `pdf` [count] is not NULL. */
VLR_API vlr_status vlr_model_eval(const vlr_model* model, const float* wv, uint64_t count, const float* wl, float* f,
                                  float* pdf);
/* Samples `count` directions wl [count x 3] for view wv from random numbers u [count x 2] in [0, 1), and returns their
 * densities. A direction may lie below the horizon. */
VLR_API vlr_status vlr_model_sample(const vlr_model* model, const float* wv, uint64_t count, const float* u, float* wl,
                                    float* pdf);

enum {
  VLR_MASKING_SEPARABLE = 0, /* G1(wv) G1(wl): Cycles before Blender 3.5 */
  VLR_MASKING_CORRELATED = 1 /* height-correlated: later versions */
};
typedef struct vlr_closure_options {
  uint32_t struct_size;
  uint32_t max_lobes; /* maximum number of glossy lobes, 1 to 3; 0: automatic */
  double tolerance;   /* error with which no more lobes are added: mean of the relative L2 errors of f cos and of its
                       * root, at views up to 75 degrees; 0: automatic */
  int32_t masking;    /* VLR_MASKING_* of the closures; VLR_MASKING_SEPARABLE */
  uint32_t threads;   /* 0: all */
} vlr_closure_options;
VLR_API void vlr_closure_options_init(vlr_closure_options* options);
/* Fits a Diffuse BSDF and the fewest Glossy BSDFs of Blender that will do to a model (docs/engine/closure_network.md).
 * Curves over the view angle have 65 samples at theta_v = 0 to pi/2, at equal distances. JSON: frame (lobes stretch in
 * the plane of "incidence" or, if the model is anisotropic, along the tangent of the "surface"), lobes [{distribution
 * "GGX", "BECKMANN" or "ASHIKHMIN_SHIRLEY", color (65 x RGB), roughness, tilt (s of the normal N + s (Incoming - N)),
 * anisotropy (65 each)}], diffuse (65 x RGB), views (degrees), relative_l2 (of the luminance of f cos against the
 * model, a number per view), relative_l2_mean (of the views up to 75 degrees), albedo_excess (largest share by which an
 * albedo exceeds the model's), seconds, reason (a sentence if the error is large, otherwise ""). VLR_UNSUPPORTED for
 * models of BTFs. Takes about half a second, three times as long for anisotropic models. */
VLR_API vlr_status vlr_model_closures_json(vlr_model* model, const vlr_closure_options* options, const char** json);

/* JSON as from vlr_measurement_info_json, vlr_model_info_json, vlr_observation_info_json or vlr_btf_info_json,
 * depending on the file or folder; the text belongs to the thread until its next call of this function. */
VLR_API vlr_status vlr_file_info_json(const char* path, const char** json);

/* ---- bidirectional texture functions ------------------------------------------------------------------------- */

/* Meaning of the values in images and .btf files (docs/engine/btf_models.md). */
enum {
  VLR_BTF_AUTOMATIC = 0,   /* as the file says; otherwise radiance for images, BRDF for .btf files */
  VLR_BTF_BRDF = 1,        /* apparent BRDF, 1/sr */
  VLR_BTF_REFLECTANCE = 2, /* pi times it */
  VLR_BTF_RADIANCE = 3     /* pi cos(theta_l) times it */
};
enum { VLR_BTF_REC709 = 0, VLR_BTF_XYZ = 1 };
/* Automatic: degrees; values that look like radians are refused. */
enum { VLR_BTF_ANGLES_AUTOMATIC = 0, VLR_BTF_DEGREES = 1, VLR_BTF_RADIANS = 2 };

typedef struct vlr_btf_options {
  uint32_t struct_size;
  int32_t values;       /* VLR_BTF_AUTOMATIC ... */
  int32_t colors;       /* images: VLR_BTF_REC709 or VLR_BTF_XYZ */
  float gamma;          /* images of integers: linear = stored^gamma; 0: the sRGB curve */
  float tile_metres[2]; /* size of the tile along x and y; 0 0: as the source says, if at all */
  const char* layer;    /* OpenEXR images: as in vlr_picture_options; NULL or "": the image itself */
  int32_t angles;       /* CSV index: VLR_BTF_ANGLES_AUTOMATIC ... */
} vlr_btf_options;
VLR_API void vlr_btf_options_init(vlr_btf_options* options);

/* Opens a BTF: a folder of Velour's own, a folder of images named by their angles (UBO2003), a CSV index of images, or
 * a .btf file from Bonn (UBO2014). Pixels are read on demand. */
VLR_API vlr_status vlr_btf_load(const char* path, const vlr_btf_options* options, vlr_btf** out);
VLR_API void vlr_btf_free(vlr_btf* btf);
/* JSON: kind "btf", format, name, path, description, sha256, bytes, raw_bytes (as half-float RGB), texels [x, y],
 * views, lights, pairs, complete, largest_theta {view, light} (degrees), tile_metres [x, y] or null, shell {thickness,
 * reference_height} or null, errors, structure, entries {pairs, values, not_finite, negative} (counted in that many
 * pairs, evenly spread if not all), details {...}. */
VLR_API vlr_status vlr_btf_info_json(vlr_btf* btf, const char** json);
/* Returns theta_l, phi_l, theta_v, phi_v of every pair in degrees, angles [pairs x 4]; `count` is the number of
 * doubles. */
VLR_API vlr_status vlr_btf_angles(const vlr_btf* btf, double* angles, uint64_t count);
/* Reads apparent BRDFs (1/sr, without cosine, linear Rec. 709) as half floats: halves [pairs x rows x columns x 3] of
 * the pairs [first, first + pairs), row 0 at the bottom (y = 0); `count` is the number of halves. */
VLR_API vlr_status vlr_btf_read(const vlr_btf* btf, uint64_t first, uint64_t pairs, uint16_t* halves, uint64_t count);
/* Writes one OpenEXR image of half floats per pair into the new folder `path`, named by its angles if all are integer
 * degrees, otherwise listed in btf.csv. JSON: format "ubo2003" or "csv", pictures, bytes, seconds. */
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
  const char* stage;     /* a literal, valid forever */
} vlr_job_state;

/* Progress callback, called on the thread that called vlr_job_wait, about ten times a second. `fraction` never
 * decreases and ends at 1 if the job succeeds. Return non-zero to continue, 0 to cancel. */
typedef int32_t (*vlr_progress_fn)(void* user, double fraction, const char* stage);

/* Starts the job on a thread of its own. A cancelled or failed job may be started again. */
VLR_API vlr_status vlr_job_start(vlr_job* job);
VLR_API vlr_status vlr_job_poll(const vlr_job* job, vlr_job_state* state);
/* Requests cancellation; the job stops within 0.1 s. */
VLR_API vlr_status vlr_job_cancel(vlr_job* job);
/* Waits at most `timeout_seconds` (negative: forever) for the job to end. On a timeout *finished is 0 and the status is
 * VLR_OK. If the job failed or was canceled, its status and sentence are returned here. `progress` may be NULL. */
VLR_API vlr_status vlr_job_wait(vlr_job* job, double timeout_seconds, vlr_progress_fn progress, void* user,
                                int32_t* finished);
/* Report of a finished job as JSON, with the keys of the command line's verb. */
VLR_API vlr_status vlr_job_report_json(vlr_job* job, const char** json);
/* The model of a finished fit, as a new handle. */
VLR_API vlr_status vlr_job_result_model(const vlr_job* job, vlr_model** out);
/* The measurement read by a finished job, as a new handle. */
VLR_API vlr_status vlr_job_result_measurement(const vlr_job* job, vlr_measurement** out);
/* The table of a finished job that makes tables for shaders (vlr_light_map_create_job and the four below it):
 * [height][width][4] floats, which belong to the job. */
VLR_API vlr_status vlr_job_result_table(const vlr_job* job, const float** rgba, uint32_t* width, uint32_t* height);
/* Cancels if running, waits, frees. */
VLR_API void vlr_job_free(vlr_job* job);

/* ---- fit, compare, capture ----------------------------------------------------------------------------------- */

enum { VLR_KERNEL_GAUSSIAN = 0, VLR_KERNEL_ABEL_POISSON = 1 };
enum {
  VLR_MODEL_SCATTERED = 0,  /* per-view model: lobes of each sampled view, mixed at run time */
  VLR_MODEL_PARAMETRIC = 1, /* few lobes for all views, whose parameters are splines of the view; Gaussian only */
  VLR_MODEL_AUTO = 2 /* parametric, or a larger model of either kind where that misses the tolerance several times */
};

typedef struct vlr_fit_options {
  uint32_t struct_size;
  int32_t kernel;     /* VLR_KERNEL_* */
  double tolerance;   /* maximum relative L2 error at every view up to 75 degrees, twice that beyond; 0.02 */
  uint32_t max_lobes; /* maximum number of lobes: per view (per-view model) or in all (parametric); 16 */
  uint32_t threads;   /* 0: all */
  uint64_t max_bytes; /* maximum size of the model file; 0: no limit */
  uint64_t seed;
  int32_t all_data;     /* 1: hold out no data (production); recorded in the model */
  int32_t align_views;  /* per-view, 1: rotate neighboring slices to the query's mirror direction before mixing */
  int32_t model;        /* VLR_MODEL_*; VLR_MODEL_AUTO */
  int32_t limit_albedo; /* parametric, 1: reduce the model where more light would leave than arrives */
  int32_t symmetric;    /* parametric, 1: f is the mean of both orders of a pair, hence reciprocal; slower */
  int32_t pad;
  /* Reduces a parametric model to this scene usage: fewer lobes over the views that are seen, as long as images are no
   * worse than with the full model. NULL: a model for any scene. */
  const vlr_observation* for_scene;
  const vlr_model* full_model; /* with for_scene: the full model; NULL: fit it first */
} vlr_fit_options;
VLR_API void vlr_fit_options_init(vlr_fit_options* options);
/* Result: a model. JSON: lobes, bytes, parameter_bytes, seconds, relative_l2, by_view_angle, albedo_max,
 * reciprocity, measured_reciprocity, verdict {quality "good", "fair" or "poor", flip_mean, flip_95, reason, value}:
 * whether pictures of the model look like pictures of the measurement (verdict/verdict.h), or null,
 * warning_codes, order {lobes [], parameter_bytes [], worst [], relative_l2 [], chosen}: how the error falls as the
 * model grows. `worst` is the largest relative L2 over tolerance of any fitted view, `chosen` the index of the
 * model's own point, or null. Parametric: also view_range [from, to], the view angles in degrees that the model
 * covers. With for_scene also scene {frames, light_density, hash, picture_error, full_picture_error,
 * full_parameter_bytes}: the errors are the relmse at the observed hits against the measurement, of this model and
 * of the full one. */
VLR_API vlr_status vlr_fit_create_job(const vlr_measurement* measurement, const vlr_fit_options* options,
                                      vlr_job** out);

/* JSON: relative_l2, by_view_angle, standard_error, standard_error_by_view_angle, log_rms, noise_by_view_angle,
 * samples, and verdict as of a fit. Standard errors say how far other directions would move the errors. */
VLR_API vlr_status vlr_compare_create_job(const vlr_measurement* measurement, const vlr_model* model, vlr_job** out);
/* Analytic materials to compare with: the GGX lobe over a diffuse base that the strategies `ggx` and `mis-ggx` sample
 * from, and Blender's Principled material: all of it, or without coat and specular tint, which differ before Blender
 * 4.0. */
enum { VLR_PEER_GGX = 0, VLR_PEER_PRINCIPLED = 1, VLR_PEER_PLAIN_PRINCIPLED = 2 };
/* Compares a measurement with the peer (VLR_PEER_*) fitted to it. JSON: as vlr_compare_create_job without verdict, and
 * seconds (of the peer's fit), parameter_bytes, and ggx {alpha [x, y], f0, f90, diffuse} or principled {base_color,
 * metallic, roughness, specular, specular_tint, coat, coat_roughness}; colors are linear Rec. 709. */
VLR_API vlr_status vlr_compare_peer_create_job(const vlr_measurement* measurement, int32_t peer, vlr_job** out);
/* Compares a model with the peer fitted to it: errors are against the model, for a BTF against its mean over the tile.
 * Views that the model does not cover are null. JSON: as vlr_compare_peer_create_job. */
VLR_API vlr_status vlr_model_peer_create_job(const vlr_model* model, int32_t peer, vlr_job** out);

typedef struct vlr_microsurface_options {
  uint32_t struct_size;
  uint32_t threads;     /* 0: all */
  double roughness;     /* Beckmann alpha = sqrt(2) x RMS slope along x; 0.01..1 */
  double anisotropy;    /* alpha_x / alpha_y >= 1; 1: isotropic, MERL layout */
  const char* metal;    /* "nickel", "gold", "copper", "aluminium", "silver", "iron", "chromium", "titanium", "brass" */
  float base_albedo[3]; /* diffuse base below the metal flakes; 0 0 0: bare metal */
  double base_share;    /* share of the surface that is diffuse base; 0..1 */
  /* Refractive index of a clear surface, 1.05..3; 0: none. Roughness and anisotropy are then its own; base and
   * metal lie below it, as pigment and flakes. */
  double ior;
  double flake_roughness; /* Beckmann alpha of the flakes below a clear surface; 0.01..0.4 */
  uint64_t rays;          /* total number of camera-side rays; more is finer and slower */
  uint64_t seed;
} vlr_microsurface_options;
VLR_API void vlr_microsurface_options_init(vlr_microsurface_options* options);
/* Ray-traces a random micro-surface and writes its BRDF, in MERL layout if isotropic, otherwise as a Velour EXR table.
 * JSON: seconds, rays, rays_per_second, bytes, resolution_degrees, relative_standard_error, albedo. */
VLR_API vlr_status vlr_microsurface_create_job(const vlr_microsurface_options* options, const char* path,
                                               vlr_job** out);

/* ---- compression of BTFs ------------------------------------------------------------------------------------- */

enum {
  VLR_COMPRESS_SVD = 0,     /* truncated singular value decomposition */
  VLR_COMPRESS_SRBF = 1,    /* multivariate SRBFs over a relief */
  VLR_COMPRESS_TUCKER = 2,  /* clustered tensors: one cluster, ... */
  VLR_COMPRESS_CTA = 3,     /* ... several, each texel in one of them, ... */
  VLR_COMPRESS_KCTA = 4,    /* ... or each texel in a few */
  VLR_COMPRESS_SVD_VIEW = 5 /* truncated singular value decomposition of each view */
};
enum { VLR_COMPAND_NONE = 0, VLR_COMPAND_ROOT = 1 };
typedef struct vlr_compress_options {
  uint32_t struct_size;
  int32_t method;     /* VLR_COMPRESS_*; default: SRBF */
  int32_t companding; /* VLR_COMPAND_*: fits f itself, or its square root (errors count about as they are perceived) */
  uint32_t threads;   /* 0: all */
  uint64_t bytes; /* maximum size of all coefficients; 0: 1/400 of the BTF as half floats (SVDs: 1/200), or a few; with
                   * a tolerance: as many as needed */
  uint64_t seed;
  const vlr_btf* held_out; /* pairs that no fit has used, of the same texels; NULL: none */
  /* Makes the model as small as images of these scenes allow, observed with a material of the BTF: it is refitted at
   * the resolution and for the views that they show, or levels that no ray resolves are left out
   * (docs/engine/scene_usage.md). NULL: a model for any scene. */
  const vlr_observation* for_scene;
  const vlr_model* full_model; /* with for_scene: the BTF's full model; NULL: fit it first */
  /* Maximum relative L2 error of companded values (docs/engine/conventions.md); the smallest model within it is chosen.
   * 0: none. */
  double tolerance;
  uint64_t memory; /* maximum bytes that the fit holds at once, beyond those of the process before; 0: no limit */
  /* Finished stages are added to this file while the fit runs, each whole or not at all; the caller deletes it once the
   * model is saved. NULL: none. With `resume`, stages in the file of the same BTF and options are not repeated, and the
   * model has the same bits as an uninterrupted fit; any other file is replaced, with a warning. */
  const char* checkpoint;
  int32_t resume;
  /* Clustered tensors: number of clusters per side (up to 256; TUCKER: 1), and number of them per texel (up to 8;
   * TUCKER, CTA: 1). 0: searched for the smallest error within the bytes. */
  uint32_t clusters;
  uint32_t members;
  int32_t no_relief; /* not for SVDs: texels lie on the reference plane, not on the structure's surface */
} vlr_compress_options;
VLR_API void vlr_compress_options_init(vlr_compress_options* options);
/* Fits a model to a BTF; vlr_job_result_model returns it. JSON: bytes, parameter_bytes, ratio (raw half floats /
 * bytes), psnr, psnr_held_out (null without held_out), ser, relative_l2, p99, evaluations_per_second, seconds, verdict
 * (of images of the tile, null for scene models), warning_codes, tolerance, order as of vlr_fit_create_job (lobes:
 * coefficients of a texel, or components; worst: relative_l2 over the tolerance, or relative_l2 without one), search
 * [{coefficients, parameter_bytes, expected, relative_l2}], the fits in their order; for clustered tensors shapes
 * [{clusters, members, texel_rank, view_rank, light_rank, color_rank, parameter_bytes, expected}], those tried before
 * the fit; components of SVDs; lobes and coefficients of SRBFs. With for_scene also texels [x, y], the finest that
 * remain, and scene, as of vlr_fit_create_job, but with full_texels [x, y] and surface (vlr_observation_info_json)
 * instead of errors; psnr, ser and speed are then those of the full model. */
VLR_API vlr_status vlr_compress_create_job(const vlr_btf* btf, const vlr_compress_options* options, vlr_job** out);
/* Estimates such a fit from the BTF's sizes alone, counting all sides: dark or equal ones are only found by reading
 * them. memory: bytes that it holds at once without a limit, beyond those of the process before; least_memory: the
 * smallest `memory` option that it can keep to; bytes: maximum size of all coefficients. Each may be NULL. Fails with
 * VLR_UNSUPPORTED for a BTF whose views lack lights. */
VLR_API vlr_status vlr_compress_size(const vlr_btf* btf, const vlr_compress_options* options, uint64_t* memory,
                                     uint64_t* least_memory, uint64_t* bytes);
/* Errors of a BTF's model against the BTF's own pairs. JSON: psnr, ser, relative_l2, brightness, p99, pairs. */
VLR_API vlr_status vlr_btf_compare_create_job(const vlr_btf* btf, const vlr_model* model, vlr_job** out);
/* Errors of another BTF with the same texels, interpolated between its own pairs; white is its own 99th percentile.
 * JSON: as vlr_btf_compare_create_job. */
VLR_API vlr_status vlr_btf_compare_btf_create_job(const vlr_btf* btf, const vlr_btf* other, vlr_job** out);

/* ---- scene --------------------------------------------------------------------------------------------------- */

VLR_API vlr_status vlr_scene_create(vlr_scene** out);
VLR_API void vlr_scene_free(vlr_scene* scene);

/* Colors of measurements, models and presets are Rec. 709; `rec709_to_working` [9, row-major] converts them to the
 * space of all other colors and images of the scene and of the film. Default: identity. */
VLR_API vlr_status vlr_scene_set_working_space(vlr_scene* scene, const float* rec709_to_working);

/* Maximum number of sets of texture coordinates that a material can use. */
enum { VLR_MOST_UV_SETS = 4 };
/* Maximum number of sets of corner colors that a material can use. */
enum { VLR_MOST_COLOR_SETS = 4 };
typedef struct vlr_mesh_desc {
  uint32_t struct_size;
  uint32_t vertex_count;
  uint32_t triangle_count;
  uint32_t color_sets;            /* at most VLR_MOST_COLOR_SETS */
  const float* positions;         /* [vertex_count x 3] */
  const uint32_t* triangles;      /* [triangle_count x 3] */
  const float* corner_normals;    /* [triangle_count x 3 x 3] shading normals; NULL: vertex_normals */
  const float* corner_uvs;        /* [triangle_count x 3 x 2]; NULL: none */
  const uint32_t* material_slots; /* [triangle_count]; NULL: all 0 */
  const uint8_t* smooth;          /* [triangle_count] 0: flat; used if corner_normals is NULL; NULL: all smooth */
  const float* more_uvs;          /* [more_uv_sets x triangle_count x 3 x 2] sets 1, 2, ... beside corner_uvs, set 0 */
  const float* relief_uvs;        /* [triangle_count x 3 x 2] for MikkTSpace tangents; NULL: set 0 */
  uint32_t more_uv_sets;          /* at most VLR_MOST_UV_SETS - 1 */
  uint32_t corner_count;
  /* If not NULL: `triangles` index corners of faces, this array [corner_count] has their vertices, and arrays of
   * triangle_count x 3 have corner_count elements instead, so that nothing need be copied to the triangles of a
   * face. */
  const uint32_t* corner_vertices;
  const float* vertex_normals; /* [vertex_count x 3] for smooth triangles; NULL: means of the adjacent triangles */
  const float* corner_colors;  /* [color_sets x triangle_count x 3 x 3] for vlr_texture_of_corners, working space */
  /* Shapes of a mesh that deforms while the shutter is open, at even times from its opening to its close and linear in
   * between; the arrays above are those of the middle. */
  const float* moved_positions;      /* [steps x vertex_count x 3] */
  const float* moved_corner_normals; /* [steps x corner_normals]; NULL: those of the triangles at each time */
  const float* moved_vertex_normals; /* [steps x vertex_count x 3]; likewise */
  uint32_t steps;                    /* 0: the mesh keeps its shape; 2..129 */
} vlr_mesh_desc;
/* Adds a mesh without its degenerate triangles and non-finite vertices; *dropped (may be NULL) is the number of
 * triangles left out. */
VLR_API vlr_status vlr_scene_add_mesh(vlr_scene* scene, const vlr_mesh_desc* desc, uint32_t* mesh, uint32_t* dropped);
/* Frees the data of a mesh that no instance uses; its index stays, as a mesh without triangles. */
VLR_API vlr_status vlr_scene_remove_mesh(vlr_scene* scene, uint32_t mesh);
/* Adds many meshes, built in parallel: all or none are added, with consecutive indices from *first. descs [count] must
 * all have the struct_size of the first; dropped [count] may be NULL. */
VLR_API vlr_status vlr_scene_add_meshes(vlr_scene* scene, const vlr_mesh_desc* descs, uint64_t count, uint32_t* first,
                                        uint32_t* dropped);
/* Reads a Wavefront OBJ file, or a Stanford PLY file if the extension is .ply. */
VLR_API vlr_status vlr_scene_load_mesh(vlr_scene* scene, const char* path, uint32_t* mesh);

/* Materials are numbered in the order in which they are added. */
/* Moves the last material into slot `material` (swap and pop). */
VLR_API vlr_status vlr_scene_replace_material(vlr_scene* scene, uint32_t material);
VLR_API vlr_status vlr_scene_add_model_material(vlr_scene* scene, const vlr_model* model, uint32_t neighbors,
                                                uint32_t* material);
/* Width in meters of a tile of the material's shell (VOTF), which scales its height; 0: as in the texture coordinates,
 * on average over each instance. Only for materials with a shell. */
VLR_API vlr_status vlr_scene_set_shell_tile(vlr_scene* scene, uint32_t material, float metres);
/* Share of the tile's width over which the edge of the material's shell (VOTF) fades out, from 0 (hard) to below 1:
 * each ray finds it at another place. */
VLR_API vlr_status vlr_scene_set_shell_softness(vlr_scene* scene, uint32_t material, float widths);
/* Multiplies the reflection of the material by `gain`: red, green, blue in the working space, finite and at least 0;
 * default (1, 1, 1). Emission, transparency and sampling are unchanged. */
VLR_API vlr_status vlr_scene_set_gain(vlr_scene* scene, uint32_t material, const float gain[3]);
/* Rays (VLR_HIDDEN_FROM_ values) that pass through the material's back, the side opposite the mesh's
 * normal; for _SHADOWS, light that falls on the back. Default 0: none. A shell has no back. */
VLR_API vlr_status vlr_scene_hide_backs(vlr_scene* scene, uint32_t material, uint32_t hidden_from);
/* Whether the material's emissive surfaces are sampled as lights (not 0; the default). 0: only the directions sampled
 * at other surfaces find their light. The image converges to the same result. */
VLR_API vlr_status vlr_scene_set_drawn_to(vlr_scene* scene, uint32_t material, int32_t drawn);
/* Replaces material `material`, of any kind, by a model; a shell keeps its tile and softness, and the gain is kept. A
 * committed scene stays committed, unless one of the two has a shell and the other none of the same heights, or only
 * the model is anisotropic. No job of the scene may run meanwhile. */
VLR_API vlr_status vlr_scene_set_model_material(vlr_scene* scene, uint32_t material, const vlr_model* model,
                                                uint32_t neighbors);
/* Reference mode: f comes from the raw measurement. `proposal` (may be NULL) is the model whose lobes are sampled;
 * without one a coarse model is fitted here, which takes about a second. */
VLR_API vlr_status vlr_scene_add_measurement_material(vlr_scene* scene, const vlr_measurement* measurement,
                                                      const vlr_model* proposal, uint32_t neighbors,
                                                      uint32_t* material);
/* Reference mode of BTFs: f comes from the BTF itself, barycentric between its directions, linear between texels and
 * mip levels. The whole BTF is read into memory as half floats; VLR_UNSUPPORTED if that takes more than `most_bytes`
 * (0: 4 GiB) or if pairs are missing. Texture coordinates count tiles. Samples follow the cosine. */
VLR_API vlr_status vlr_scene_add_btf_material(vlr_scene* scene, const vlr_btf* btf, uint64_t most_bytes,
                                              uint32_t* material);
/* Version of the Principled BSDF: that of Blender 4.0 and newer, whose layers pass on what they do not reflect; or
 * Disney's, of Blender before 4.0. The equations are in docs/engine/equations.md. */
enum { VLR_PRINCIPLED_LAYERED = 0, VLR_PRINCIPLED_DISNEY = 1 };
/* Shadowing and masking of GGX facets. */
enum {
  VLR_GGX_WHOLE = 0,    /* height-correlated, with scattering between facets: Blender's Multiscatter GGX since 4.0 */
  VLR_GGX_SINGLE = 1,   /* height-correlated: GGX since Blender 3.5 */
  VLR_GGX_SEPARABLE = 2 /* independent for both directions: GGX before Blender 3.5 */
};
/* How glass divides light: by the angle with each facet, as the Glass BSDF since Blender 3.6 and the Refraction BSDF
 * since 4.0; or by the angle with the surface, as before. */
enum { VLR_GLASS_FACETS = 0, VLR_GLASS_SURFACE = 1 };
typedef struct vlr_principled_desc {
  uint32_t struct_size;
  float base_color[3]; /* working space */
  float metallic;      /* 0..1 */
  float roughness;     /* 0..1, Principled's: alpha = roughness^2 */
  float specular;      /* 0..11.25: reflectance at normal incidence / 0.08; 0.5 = index 1.5 */
  float emission[3];   /* radiance, working space */
  float alpha;         /* 0..1: opacity; rays pass through the remaining share */
  int32_t formula;     /* VLR_PRINCIPLED_* */
  int32_t lobe;        /* VLR_GGX_* */
  /* Dielectrics: at normal incidence, not negative; metals: near 82 degrees, 0..1 (VLR_PRINCIPLED_LAYERED). White. */
  float specular_tint[3];
  /* A dielectric layer on top, not affected by a normal map; VLR_PRINCIPLED_DISNEY: its clear coat. */
  float coat;           /* 0..1: its weight; 0 */
  float coat_roughness; /* 0..1; 0.03 */
  float coat_index;     /* at least 1; 1.5 */
  float coat_tint[3];   /* not negative: its transmission straight down and back; white */
  int32_t coat_lobe;    /* VLR_GGX_WHOLE since Blender 4.5; VLR_GGX_SINGLE: 4.0 to 4.4, which dim the layers below as a
                           smooth coat does */
  float transmission;   /* 0..1: share of glass in what is not metal; 0 */
  float transmission_roughness; /* 0..1, VLR_PRINCIPLED_DISNEY: adds to that of refraction; 0 */
  float index;                  /* > 0: index of refraction of glass; 1.5. Below 1 it inverts that of the dielectric
                                   (VLR_PRINCIPLED_LAYERED) */
  int32_t glass_fresnel;        /* VLR_GLASS_*, of glass and refraction layers */
  float sheen;                  /* weight of fuzz, not negative; 0 */
  float sheen_roughness;        /* 0..1, VLR_PRINCIPLED_LAYERED; 0.5 */
  float sheen_tint[3];          /* not negative; white */
  int32_t specular_of_index;    /* 1: specular 0.5 means the reflectance of `index`, not of 1.5 */
  int32_t surface_correction;   /* VLR_RELIEF_*: of interpolated normals where a view is mirrored below the face;
                                   VLR_RELIEF_AS_IT_IS */
} vlr_principled_desc;
VLR_API void vlr_principled_desc_init(vlr_principled_desc* desc);
VLR_API vlr_status vlr_scene_add_principled_material(vlr_scene* scene, const vlr_principled_desc* desc,
                                                     uint32_t* material);

/* object_to_world [12]: 3 x 4 row-major. materials [count]: material of each slot of the mesh. */
VLR_API vlr_status vlr_scene_add_instance(vlr_scene* scene, uint32_t mesh, const float* object_to_world,
                                          const uint32_t* materials, uint32_t count);
/* Adds an instance with placements [count x 6]: for each slot a map [2 x 3, row-major] from (u, v, 1) of the mesh to
 * the texture coordinates of its material, as if the mesh had those; footprints, and the tangent that anisotropy
 * follows, are mapped with them. An anisotropic BRDF is rotated as the map rotates, by angles on the surface, however
 * much texture coordinates are stretched there. NULL: the mesh's own. */
VLR_API vlr_status vlr_scene_add_placed_instance(vlr_scene* scene, uint32_t mesh, const float* object_to_world,
                                                 const uint32_t* materials, const float* placements, uint32_t count);
/* Adds instances that differ only in their meshes [instances] and matrices, object_to_world [instances x 12]. If one is
 * refused, those before it have been added. */
VLR_API vlr_status vlr_scene_add_instances(vlr_scene* scene, const uint32_t* meshes, const float* object_to_world,
                                           uint64_t instances, const uint32_t* materials, uint32_t count);

/* Applies to all instances added from here on: each has `steps` (1..129) matrices in a row in place of one, where it is
 * at even times while the shutter is open; rotations turn evenly in between. 1 (initially): it stays. */
VLR_API vlr_status vlr_scene_move_instances(vlr_scene* scene, uint32_t steps);
/* Removes all instances; meshes and materials stay. */
VLR_API vlr_status vlr_scene_clear_instances(vlr_scene* scene);

/* Bits: rays that pass through an instance as if it were not there. _BOUNCES: reflected rays; _TRANSMISSION: rays that
 * surfaces have transmitted. They also find the light of a world of one color, whose light _SHADOWS does not let pass,
 * and all light along the lobes of clear glass. VLR_HOLDOUT: the camera sees neither the instance
 * nor anything behind it: black, alpha 0. */
enum {
  VLR_HIDDEN_FROM_CAMERA = 1,
  VLR_HIDDEN_FROM_BOUNCES = 2,
  VLR_HIDDEN_FROM_SHADOWS = 4,
  VLR_HOLDOUT = 8,
  VLR_HIDDEN_FROM_TRANSMISSION = 16
};
/* Applies to all instances added from here on; 0 (initially): hidden from no rays. */
VLR_API vlr_status vlr_scene_hide_instances(vlr_scene* scene, uint32_t hidden_from);
/* Shadow terminator of all instances added from here on: where light arrives at a cosine below `offset` (0 to 1),
 * shadow rays start on the smooth surface implied by the shading normals, so that coarse meshes show no steps. Cycles'
 * default is 0.1; 0 (initially): they start on the mesh. */
VLR_API vlr_status vlr_scene_soften_terminator(vlr_scene* scene, float offset);

enum { VLR_LIGHT_SUN = 0, VLR_LIGHT_POINT = 1, VLR_LIGHT_RECTANGLE = 2, VLR_LIGHT_DISK = 3, VLR_LIGHT_SPOT = 4 };
typedef struct vlr_light_desc {
  uint32_t struct_size;
  int32_t type;   /* VLR_LIGHT_* */
  float color[3]; /* working space. Sun: irradiance on a facing plane, W/m^2. Others: power, W; spot: as if its cone
                     were a sphere */
  float light_to_world[12]; /* 3 x 4 row-major; the light shines along its -z */
  float size[2];            /* point, spot: radius, -; rectangle: sides; disk: diameters (an ellipse if they differ) */
  float angle;              /* sun: angular diameter; spot: angle of its cone; radians */
  int32_t casts_shadow;
  float blend;          /* spot: share of the cone over which its light fades out, 0..1; 0 */
  float spread;         /* rectangle, disk: full angle of emission, radians; pi: the same radiance in all directions */
  int32_t sphere;       /* point, spot: 1: a ball; 0: a disk that faces each lit point, like Cycles' soft falloff */
  int32_t cosine;       /* spot: 1: its light also falls off with the cosine to the axis, as in Blender before 3.5 */
  float cone_scale[2];  /* spot: factors by which its cone is wider along its x and y; 1, 1 */
  int32_t mirrored;     /* 0: clear glass does not show it; 1 */
  uint32_t hidden_from; /* VLR_HIDDEN_FROM_BOUNCES, _TRANSMISSION: rays that it does not light; 0 */
} vlr_light_desc;
VLR_API void vlr_light_desc_init(vlr_light_desc* desc);
VLR_API vlr_status vlr_scene_add_light(vlr_scene* scene, const vlr_light_desc* desc);
VLR_API vlr_status vlr_scene_clear_lights(vlr_scene* scene);

/* How an image file is read (vlr_picture_read). */
typedef struct vlr_picture_options {
  uint32_t struct_size;
  int32_t as_stored; /* 1: as Blender shows it: ignores the header's orientation, exposure, primaries and windows */
  const char* layer; /* OpenEXR: name of a layer, part or channel; NULL or "": the image itself */
} vlr_picture_options;
VLR_API void vlr_picture_options_init(vlr_picture_options* options);

/* The world is +z up. Image: equirectangular, row 0 at the top (+z), in Blender's convention: the middle column looks
 * along +x; u = 1/2 - atan2(y, x) / (2 pi) from the left, v = 1/2 + asin(z) / pi from the bottom. world_to_image [9,
 * row-major] transforms a world direction before that look-up (NULL: identity). */
VLR_API vlr_status vlr_scene_set_world_color(vlr_scene* scene, const float* color);
VLR_API vlr_status vlr_scene_set_world_pixels(vlr_scene* scene, uint32_t width, uint32_t height, uint32_t channels,
                                              const float* pixels, float strength, const float* world_to_image);
VLR_API vlr_status vlr_scene_load_world(vlr_scene* scene, const char* path, float strength,
                                        const float* world_to_image);
/* Loads a world image with options (vlr_picture_read). Parts of the file that were left out or replaced are among the
 * warning_codes of vlr_scene_info_json. */
VLR_API vlr_status vlr_scene_load_world_picture(vlr_scene* scene, const char* path, const vlr_picture_options* options,
                                                float strength, const float* world_to_image);
/* Rays that the world does not light: VLR_HIDDEN_FROM_BOUNCES, _TRANSMISSION; 0 (initially): none. */
VLR_API vlr_status vlr_scene_hide_world(vlr_scene* scene, uint32_t hidden_from);
/* An output of a program that is a color: radiance by the direction in which a ray leaves the scene, as
 * vlr_program_radiance() returns it. Camera rays see the program itself; all others see an image of width x height
 * texels, at most 16384 each, that is made of it (a color if it depends on no direction). */
VLR_API vlr_status vlr_scene_set_world_program(vlr_scene* scene, const vlr_program* program, uint32_t output,
                                               uint32_t width, uint32_t height);
/* Changes strength and rotation of the world's image without reading it again. Refused if the world is a color. */
VLR_API vlr_status vlr_scene_place_world(vlr_scene* scene, float strength, const float* world_to_image);

enum { VLR_CAMERA_PERSPECTIVE = 0, VLR_CAMERA_ORTHOGRAPHIC = 1 };
typedef struct vlr_camera_desc {
  uint32_t struct_size;
  int32_t type;              /* VLR_CAMERA_* */
  float camera_to_world[12]; /* 3 x 4 row-major; looks along its -z, +y up */
  float window[4];           /* left, right, bottom, top of the image: at distance 1 (perspective) or in meters */
  float clip_start, clip_end;
  float aperture;       /* radius of a thin lens in meters; 0: everything is sharp */
  float focus;          /* meters along -z to the plane in focus; 1 */
  uint32_t blades;      /* sides of the aperture, with corners on the circle; below 3: the circle; 0 */
  float blade_rotation; /* rotation of that polygon, counterclockwise as seen by the camera, radians */
  float aperture_ratio; /* height over width of the aperture; 1 */
  /* How far the shutter is open, at even times from its opening to its close, at least 0 and linear in between: camera
   * rays are distributed over time in proportion, and what moves blurs. NULL: it opens for an instant in the middle. */
  const float* shutter; /* [shutter_count] */
  /* Where a camera that moves is at such times, in between as instances are, and its windows; camera_to_world and
   * window are then ignored. NULL: it stays, or does not zoom. */
  const float* motion;        /* [steps x 12] */
  const float* motion_window; /* [steps x 4] */
  uint32_t shutter_count;     /* 1: constant */
  uint32_t steps;             /* of `motion` and `motion_window`; 0, 2..129 */
} vlr_camera_desc;
VLR_API void vlr_camera_desc_init(vlr_camera_desc* desc);
VLR_API vlr_status vlr_scene_set_camera(vlr_scene* scene, const vlr_camera_desc* desc);
/* Perspective camera from `eye` to `target`; fov is the vertical angle of view. Up is +z. */
VLR_API vlr_status vlr_scene_look_at(vlr_scene* scene, const float* eye, const float* target, float fov, float aspect);
/* The default camera: frames the bounding box of all instances to the image's height. `up_axis`: 1 (y) or 2 (z). */
VLR_API vlr_status vlr_scene_frame_camera(vlr_scene* scene, float aspect, uint32_t up_axis);

/* Builds the acceleration structure and checks the scene. Required after every change, before a render job is created.
 * Only changes are rebuilt: a camera, a light, a world or a plain material costs next to nothing, an instance the top
 * level of the structure, a mesh that mesh. */
VLR_API vlr_status vlr_scene_commit(vlr_scene* scene);
/* Declares before the first commit that no mesh and no instance changes after it: rays are faster. The last bits of an
 * image differ from those of a scene that may change. */
VLR_API vlr_status vlr_scene_stay(vlr_scene* scene);
/* JSON: triangles, instances, meshes, lights, materials, untextured (instances of a mesh without texture coordinates
 * whose material varies over the surface: one point of it is shown everywhere), camera_inside (committed scenes: index
 * of the instance that encloses the camera and is all it sees, or null), bytes, bvh_seconds, warning_codes. */
VLR_API vlr_status vlr_scene_info_json(vlr_scene* scene, const char** json);

/* ---- textures ------------------------------------------------------------------------------------------------ */

enum { VLR_WRAP_REPEAT = 0, VLR_WRAP_EXTEND = 1, VLR_WRAP_CLIP = 2, VLR_WRAP_MIRROR = 3 };
enum { VLR_FILTER_CLOSEST = 0, VLR_FILTER_LINEAR = 1 };

typedef struct vlr_texture_options {
  uint32_t struct_size;
  int32_t wrap;    /* VLR_WRAP_*: outside the image: repeat, extend its border, 0, mirror */
  int32_t filter;  /* VLR_FILTER_*: between magnified texels; minified ones are always averaged */
  int32_t channel; /* channel of a number; -1: a color from the first three channels (of one or two: the first) */
  int32_t raw;     /* vlr_texture_load: 1: integer values are numbers from 0 to 1; 0: they are sRGB colors */
  /* If one is 1, the image has four channels and is interpolated as in Cycles, before it is decoded: the result is
   * divided by alpha (`premultiplied`), made linear (`srgb`) and multiplied by `colors`; `channel` selects from that.
   */
  int32_t srgb;          /* 1: colors have the sRGB curve */
  int32_t premultiplied; /* 1: colors are multiplied by alpha and are to be divided by it, unless it is 0 */
  float colors[9];       /* row-major, from the colors of the image to the working space; identity */
} vlr_texture_options;
VLR_API void vlr_texture_options_init(vlr_texture_options* options);
/* Texture coordinates (0, 0) are the lower left corner of the picture, (1, 1) the upper right. `pixels` [height x width
 * x channels], row 0 at the bottom: linear, colors in the working space, unless `options` says otherwise; they are
 * copied. NaN counts as 0, infinity as the largest finite value. */
VLR_API vlr_status vlr_texture_create(uint32_t width, uint32_t height, uint32_t channels, const float* pixels,
                                      const vlr_texture_options* options, vlr_texture** out);
/* Loads an image file, whose colors are used as they are, in any working space. */
VLR_API vlr_status vlr_texture_load(const char* path, const vlr_texture_options* options, vlr_texture** out);
/* Interpolated colors of the mesh's own corners, instead of an image: those of this set, below VLR_MOST_COLOR_SETS;
 * black on meshes without it. They serve as a color, or by their first channel as a number; maps and sets of texture
 * coordinates are ignored. */
VLR_API vlr_status vlr_texture_of_corners(uint32_t set, vlr_texture** out);
VLR_API void vlr_texture_free(vlr_texture* texture);

/* Parameters of vlr_principled_desc: numbers, then colors. */
enum {
  VLR_PARAMETER_SPECULAR = 0,
  VLR_PARAMETER_COAT = 1,
  VLR_PARAMETER_COAT_ROUGHNESS = 2,
  VLR_PARAMETER_COAT_INDEX = 3,
  VLR_PARAMETER_TRANSMISSION = 4,
  VLR_PARAMETER_TRANSMISSION_ROUGHNESS = 5,
  VLR_PARAMETER_INDEX = 6,
  VLR_PARAMETER_SHEEN = 7,
  VLR_PARAMETER_SHEEN_ROUGHNESS = 8,
  VLR_PARAMETER_SPECULAR_TINT = 9,
  VLR_PARAMETER_COAT_TINT = 10,
  VLR_PARAMETER_SHEEN_TINT = 11
};
/* A texture in place of a parameter; map and set as in vlr_principled_textures. */
typedef struct vlr_parameter_texture {
  int32_t parameter; /* VLR_PARAMETER_* */
  uint32_t set;
  const vlr_texture* texture;
  float map[6];
} vlr_parameter_texture;

/* Each may be NULL: the value in vlr_principled_desc holds. A map [2 x 3, row-major] takes (u, v, 1) of the surface to
 * the image's coordinates. */
typedef struct vlr_principled_textures {
  uint32_t struct_size;
  uint32_t pad;
  const vlr_texture* base_color; /* a color */
  const vlr_texture* metallic;   /* numbers, like the next two */
  const vlr_texture* roughness;
  const vlr_texture* alpha;
  float base_color_map[6];
  float metallic_map[6];
  float roughness_map[6];
  float alpha_map[6];
  uint32_t base_color_set; /* set of the mesh's texture coordinates; 0. A mesh without that set uses its first. */
  uint32_t metallic_set;
  uint32_t roughness_set;
  uint32_t alpha_set;
  const vlr_parameter_texture* more; /* of other parameters; layers of kind VLR_LAYER_PRINCIPLED only */
  uint32_t more_count;
} vlr_principled_textures;
VLR_API void vlr_principled_textures_init(vlr_principled_textures* textures);
VLR_API vlr_status vlr_scene_add_textured_material(vlr_scene* scene, const vlr_principled_desc* desc,
                                                   const vlr_principled_textures* textures, uint32_t* material);

/* ---- programs: values computed at each point ------------------------------------------------------------------- */

/* Operations are Blender's nodes of the same name, with the formulas of Cycles. Inputs -> outputs; choices. A number
 * after a name counts registers, else it is one; tables are rows of floats. Undefined values, like 1 / 0, are 0.
 *
 * SOURCE -> value 3; VLR_SOURCE_*, set, VLR_SHIFT_*
 * IMAGE place 3 -> color 3; number of the image, which is read at a point
 * MATH a, b, c -> value; VLR_MATH_*, 1: clamped to [0, 1]
 * VECTOR_MATH a 3, b 3, c 3, scale -> vector 3, value; VLR_VECTOR_*
 * MIX_COLOR factor, a 3, b 3 -> color 3; VLR_BLEND_*, 1: factor clamped, 1: color clamped
 * MIX_NUMBER factor, a, b -> value; 1: factor clamped
 * MIX_VECTOR factor 3, a 3, b 3 -> vector 3; 1: factor clamped
 * COMBINE 3 components -> color 3; VLR_COLOR_MODEL_*
 * SEPARATE color 3 -> 3 components; VLR_COLOR_MODEL_*
 * RAMP factor -> color 3, alpha; 1: interpolated; table: at least 2 rows of RGBA, evenly from 0 to 1
 * CURVES factor, color 3, place of the first and of the last row -> color 3; 1: continued beyond the table; table: at
 *   least 2 rows of RGB
 * HUE_SATURATION hue, saturation, value, factor, color 3 -> color 3
 * INVERT factor, color 3 -> color 3
 * GAMMA color 3, gamma -> color 3
 * BRIGHT_CONTRAST color 3, bright, contrast -> color 3
 * CLAMP value, min, max -> value; 1: min and max may be swapped
 * MAP_RANGE value, from min, from max, to min, to max, steps -> value; VLR_RANGE_*, 1: clamped
 * MAP_RANGE_VECTOR the same of vectors, each 3 -> vector 3; VLR_RANGE_*, 1: clamped unless smooth
 * MAPPING vector 3, location 3, rotation 3 (radians), scale 3 -> vector 3; VLR_MAPPING_*
 * TRANSFORM point 3 -> point 3; table: 3 x 4 matrix, row-major
 * FRESNEL ior, normal 3, incoming 3, backfacing -> factor
 * LAYER_WEIGHT blend, normal 3, incoming 3, backfacing -> fresnel, facing
 * NOISE vector 3, w, scale, detail, roughness, lacunarity, offset, gain, distortion -> value, color 3; dimensions - 1,
 *   VLR_NOISE_*, 1: normalized (fBM), 1: the color is needed. Detail may be down to -1: no octave at all
 * VORONOI vector 3, w, scale, detail, roughness, lacunarity, smoothness, exponent, randomness -> distance, color 3,
 *   position 3, w, radius; dimensions - 1, VLR_VORONOI_*, VLR_METRIC_*, 1: normalized + 2: integer hash of Blender 5
 * WAVE vector 3, scale, distortion, detail, detail scale, detail roughness, phase -> factor; 0: bands, 1: rings,
 *   VLR_WAVE_AXIS_*, VLR_WAVE_PROFILE_*
 * GRADIENT vector 3 -> factor; VLR_GRADIENT_*
 * CHECKER vector 3, color 3, color 3, scale -> factor, color 3
 * BRICK vector 3, color 3, color 3, mortar 3, scale, mortar size, mortar smooth, bias, width, height, offset, squash ->
 *   factor, color 3; frequencies of offset and squash
 * MAGIC vector 3, scale, distortion -> factor, color 3; depth, 1: scaled before it is wrapped, as in newer Blenders
 * WHITE_NOISE vector 3, w -> value, color 3; dimensions - 1
 * NORMAL_MAP color 3, strength, tangent 3, bitangent 3, normal 3, normal without tangents 3 -> unit normal 3
 * BUMP strength, distance, height, heights shifted by x and by y, normal 3, step x 3, step y 3 -> unit normal 3 */
enum {
  VLR_OPERATION_SOURCE = 0,
  VLR_OPERATION_IMAGE = 1,
  VLR_OPERATION_MATH = 2,
  VLR_OPERATION_VECTOR_MATH = 3,
  VLR_OPERATION_MIX_COLOR = 4,
  VLR_OPERATION_MIX_VECTOR = 5,
  VLR_OPERATION_COMBINE = 6,
  VLR_OPERATION_SEPARATE = 7,
  VLR_OPERATION_RAMP = 8,
  VLR_OPERATION_CURVES = 9,
  VLR_OPERATION_HUE_SATURATION = 10,
  VLR_OPERATION_INVERT = 11,
  VLR_OPERATION_GAMMA = 12,
  VLR_OPERATION_BRIGHT_CONTRAST = 13,
  VLR_OPERATION_CLAMP = 14,
  VLR_OPERATION_MAP_RANGE = 15,
  VLR_OPERATION_MAPPING = 16,
  VLR_OPERATION_TRANSFORM = 17,
  VLR_OPERATION_FRESNEL = 18,
  VLR_OPERATION_LAYER_WEIGHT = 19,
  VLR_OPERATION_NOISE = 20,
  VLR_OPERATION_VORONOI = 21,
  VLR_OPERATION_WAVE = 22,
  VLR_OPERATION_GRADIENT = 23,
  VLR_OPERATION_CHECKER = 24,
  VLR_OPERATION_BRICK = 25,
  VLR_OPERATION_MAGIC = 26,
  VLR_OPERATION_WHITE_NOISE = 27,
  VLR_OPERATION_NORMAL_MAP = 28,
  VLR_OPERATION_BUMP = 29,
  VLR_OPERATION_MIX_NUMBER = 30,
  VLR_OPERATION_MAP_RANGE_VECTOR = 31
};
/* Properties of the surface at a point; directions are unit and in world space unless noted. UV: coordinates of the
 * set, and 0. CORNER: corner colors of the set. POSITION: meters. OBJECT_POSITION, OBJECT_NORMAL: object space. NORMAL:
 * shading normal on the viewer's side, as is GEOMETRIC_NORMAL. INCOMING: towards the viewer. BACKFACING: 1 behind the
 * mesh's normal. MAP_*: axes of normal maps in tangent space. STEP_X and STEP_Y: from the point to the shifted points
 * of VLR_SHIFT_*, about a pixel wide, meters. CAMERA_RAY, SHADOW_RAY: 1 for rays of that kind. */
enum {
  VLR_SOURCE_UV = 0,
  VLR_SOURCE_CORNER = 1,
  VLR_SOURCE_POSITION = 2,
  VLR_SOURCE_OBJECT_POSITION = 3,
  VLR_SOURCE_NORMAL = 4,
  VLR_SOURCE_OBJECT_NORMAL = 5,
  VLR_SOURCE_GEOMETRIC_NORMAL = 6,
  VLR_SOURCE_INCOMING = 7,
  VLR_SOURCE_BACKFACING = 8,
  VLR_SOURCE_MAP_TANGENT = 9,
  VLR_SOURCE_MAP_BITANGENT = 10,
  VLR_SOURCE_MAP_NORMAL = 11,
  VLR_SOURCE_STEP_X = 12,
  VLR_SOURCE_STEP_Y = 13,
  VLR_SOURCE_CAMERA_RAY = 14,
  VLR_SOURCE_SHADOW_RAY = 15
};
enum { VLR_SHIFT_NONE = 0, VLR_SHIFT_X = 1, VLR_SHIFT_Y = 2 };
enum {
  VLR_MATH_ADD = 0,
  VLR_MATH_SUBTRACT = 1,
  VLR_MATH_MULTIPLY = 2,
  VLR_MATH_DIVIDE = 3,
  VLR_MATH_MULTIPLY_ADD = 4,
  VLR_MATH_POWER = 5,
  VLR_MATH_LOGARITHM = 6,
  VLR_MATH_SQRT = 7,
  VLR_MATH_INVERSE_SQRT = 8,
  VLR_MATH_ABSOLUTE = 9,
  VLR_MATH_EXPONENT = 10,
  VLR_MATH_MINIMUM = 11,
  VLR_MATH_MAXIMUM = 12,
  VLR_MATH_LESS_THAN = 13,
  VLR_MATH_GREATER_THAN = 14,
  VLR_MATH_SIGN = 15,
  VLR_MATH_COMPARE = 16,
  VLR_MATH_SMOOTH_MIN = 17,
  VLR_MATH_SMOOTH_MAX = 18,
  VLR_MATH_ROUND = 19,
  VLR_MATH_FLOOR = 20,
  VLR_MATH_CEIL = 21,
  VLR_MATH_TRUNC = 22,
  VLR_MATH_FRACT = 23,
  VLR_MATH_MODULO = 24,
  VLR_MATH_FLOORED_MODULO = 25,
  VLR_MATH_WRAP = 26,
  VLR_MATH_SNAP = 27,
  VLR_MATH_PINGPONG = 28,
  VLR_MATH_SINE = 29,
  VLR_MATH_COSINE = 30,
  VLR_MATH_TANGENT = 31,
  VLR_MATH_ARCSINE = 32,
  VLR_MATH_ARCCOSINE = 33,
  VLR_MATH_ARCTANGENT = 34,
  VLR_MATH_ARCTAN2 = 35,
  VLR_MATH_SINH = 36,
  VLR_MATH_COSH = 37,
  VLR_MATH_TANH = 38,
  VLR_MATH_RADIANS = 39,
  VLR_MATH_DEGREES = 40
};
enum {
  VLR_VECTOR_ADD = 0,
  VLR_VECTOR_SUBTRACT = 1,
  VLR_VECTOR_MULTIPLY = 2,
  VLR_VECTOR_DIVIDE = 3,
  VLR_VECTOR_MULTIPLY_ADD = 4,
  VLR_VECTOR_CROSS_PRODUCT = 5,
  VLR_VECTOR_PROJECT = 6,
  VLR_VECTOR_REFLECT = 7,
  VLR_VECTOR_REFRACT = 8,
  VLR_VECTOR_FACEFORWARD = 9,
  VLR_VECTOR_DOT_PRODUCT = 10,
  VLR_VECTOR_DISTANCE = 11,
  VLR_VECTOR_LENGTH = 12,
  VLR_VECTOR_SCALE = 13,
  VLR_VECTOR_NORMALIZE = 14,
  VLR_VECTOR_ABSOLUTE = 15,
  VLR_VECTOR_MINIMUM = 16,
  VLR_VECTOR_MAXIMUM = 17,
  VLR_VECTOR_FLOOR = 18,
  VLR_VECTOR_CEIL = 19,
  VLR_VECTOR_FRACTION = 20,
  VLR_VECTOR_MODULO = 21,
  VLR_VECTOR_WRAP = 22,
  VLR_VECTOR_SNAP = 23,
  VLR_VECTOR_SINE = 24,
  VLR_VECTOR_COSINE = 25,
  VLR_VECTOR_TANGENT = 26,
  VLR_VECTOR_POWER = 27,
  VLR_VECTOR_SIGN = 28,
  VLR_VECTOR_ROUND = 29
};
enum {
  VLR_BLEND_MIX = 0,
  VLR_BLEND_DARKEN = 1,
  VLR_BLEND_MULTIPLY = 2,
  VLR_BLEND_BURN = 3,
  VLR_BLEND_LIGHTEN = 4,
  VLR_BLEND_SCREEN = 5,
  VLR_BLEND_DODGE = 6,
  VLR_BLEND_ADD = 7,
  VLR_BLEND_OVERLAY = 8,
  VLR_BLEND_SOFT_LIGHT = 9,
  VLR_BLEND_LINEAR_LIGHT = 10,
  VLR_BLEND_DIFFERENCE = 11,
  VLR_BLEND_EXCLUSION = 12,
  VLR_BLEND_SUBTRACT = 13,
  VLR_BLEND_DIVIDE = 14,
  VLR_BLEND_HUE = 15,
  VLR_BLEND_SATURATION = 16,
  VLR_BLEND_COLOR = 17,
  VLR_BLEND_VALUE = 18
};
enum { VLR_COLOR_MODEL_RGB = 0, VLR_COLOR_MODEL_HSV = 1, VLR_COLOR_MODEL_HSL = 2 };
enum { VLR_RANGE_LINEAR = 0, VLR_RANGE_STEPPED = 1, VLR_RANGE_SMOOTHSTEP = 2, VLR_RANGE_SMOOTHERSTEP = 3 };
enum { VLR_MAPPING_POINT = 0, VLR_MAPPING_TEXTURE = 1, VLR_MAPPING_VECTOR = 2, VLR_MAPPING_NORMAL = 3 };
enum {
  VLR_NOISE_FBM = 0,
  VLR_NOISE_MULTIFRACTAL = 1,
  VLR_NOISE_HYBRID_MULTIFRACTAL = 2,
  VLR_NOISE_RIDGED_MULTIFRACTAL = 3,
  VLR_NOISE_HETERO_TERRAIN = 4
};
enum {
  VLR_VORONOI_F1 = 0,
  VLR_VORONOI_F2 = 1,
  VLR_VORONOI_SMOOTH_F1 = 2,
  VLR_VORONOI_DISTANCE_TO_EDGE = 3,
  VLR_VORONOI_N_SPHERE_RADIUS = 4
};
enum { VLR_METRIC_EUCLIDEAN = 0, VLR_METRIC_MANHATTAN = 1, VLR_METRIC_CHEBYCHEV = 2, VLR_METRIC_MINKOWSKI = 3 };
enum { VLR_WAVE_AXIS_X = 0, VLR_WAVE_AXIS_Y = 1, VLR_WAVE_AXIS_Z = 2, VLR_WAVE_AXIS_WHOLE = 3 };
enum { VLR_WAVE_PROFILE_SIN = 0, VLR_WAVE_PROFILE_SAW = 1, VLR_WAVE_PROFILE_TRI = 2 };
enum {
  VLR_GRADIENT_LINEAR = 0,
  VLR_GRADIENT_QUADRATIC = 1,
  VLR_GRADIENT_EASING = 2,
  VLR_GRADIENT_DIAGONAL = 3,
  VLR_GRADIENT_SPHERICAL = 4,
  VLR_GRADIENT_QUADRATIC_SPHERE = 5,
  VLR_GRADIENT_RADIAL = 6
};
enum { VLR_VALUE_COLOR = 0, VLR_VALUE_NUMBER = 1, VLR_VALUE_NORMAL = 2 };

typedef struct vlr_instruction {
  int32_t operation;   /* VLR_OPERATION_* */
  int32_t choice[4];   /* unused ones are 0 */
  uint32_t input[12];  /* first register of each input */
  uint32_t output;     /* first register of all outputs */
  uint32_t table;      /* index of its first value in vlr_program_desc.tables */
  uint32_t table_size; /* number of its values; 0 for operations without a table */
} vlr_instruction;

typedef struct vlr_program_output {
  uint32_t first; /* register */
  int32_t kind;   /* VLR_VALUE_*: 3 registers, a single one, or a unit direction in world space */
} vlr_program_output;

/* Instructions run in order. Each register is written once, by a constant or an instruction, before it is read. The
 * arrays are copied. */
typedef struct vlr_program_desc {
  uint32_t struct_size;
  uint32_t registers; /* at most 16384 */
  uint32_t constant_count;
  uint32_t instruction_count; /* at most 4096 */
  uint32_t table_count;       /* at most 4194304 */
  uint32_t image_count;
  uint32_t output_count;  /* at most 16 */
  float step;             /* distance of shifted points as a share of a pixel's width; 1 */
  const float* constants; /* values of the first registers */
  const vlr_instruction* instructions;
  const float* tables;
  const vlr_texture* const* images; /* of pixels */
  const vlr_program_output* outputs;
} vlr_program_desc;
VLR_API void vlr_program_desc_init(vlr_program_desc* desc);

/* Refuses, with a sentence that names the instruction, what is not a program. */
VLR_API vlr_status vlr_program_create(const vlr_program_desc* desc, vlr_program** out);
VLR_API void vlr_program_free(vlr_program* program);
/* Radiance [count x 3] of a world whose color is an output of a program, in unit directions [count x 3]. POSITION and
 * OBJECT_POSITION are the direction, INCOMING and all NORMALs its negative. CAMERA_RAY is 1 for rays of kind
 * VLR_WORLD_RAYS_CAMERA, SHADOW_RAY for VLR_WORLD_RAYS_SHADOW. Other sources are 0. */
enum { VLR_WORLD_RAYS_OTHERS = 0, VLR_WORLD_RAYS_CAMERA = 1, VLR_WORLD_RAYS_SHADOW = 2 };
VLR_API vlr_status vlr_program_radiance(const vlr_program* program, uint32_t output, int32_t rays, uint32_t count,
                                        const float* directions, float* radiance);
/* An output of a program, instead of an image: as a color, a number or a normal map (an output that is a normal). Maps
 * and sets of texture coordinates are ignored. All parameters of a material use one program, which runs once for each
 * point. */
VLR_API vlr_status vlr_texture_of_program(const vlr_program* program, uint32_t output, vlr_texture** out);

/* ---- shaders: materials mixed from others --------------------------------------------------------------------- */

enum {
  VLR_LAYER_PRINCIPLED = 0,
  VLR_LAYER_DIFFUSE = 1,     /* base_color and roughness: Oren-Nayar; 0: Lambert */
  VLR_LAYER_GLOSSY = 2,      /* base_color, roughness and lobe: GGX with this reflectance at every angle */
  VLR_LAYER_TRANSPARENT = 3, /* base_color: factor of light that passes straight through */
  VLR_LAYER_EMISSION = 4,    /* base_color: radiance */
  VLR_LAYER_GLASS = 5,      /* base_color, roughness, index, lobe, glass_fresnel: GGX facets that reflect and refract */
  VLR_LAYER_REFRACTION = 6, /* the same, without reflection */
  VLR_LAYER_TRANSLUCENT = 7 /* base_color: diffuse light from the other side */
};
/* The weight of a layer is the product of its factors. For a mix, SHARE is its factor and REST 1 minus that, both
 * within [0, 1]; GAIN is any number, below 0 only for emission; LEVEL is the layer's share in a sequence of layers for
 * levels of a number. */
enum {
  VLR_FACTOR_SHARE = 0,
  VLR_FACTOR_REST = 1,
  VLR_FACTOR_GAIN = 2,
  VLR_FACTOR_TINT = 3, /* a color that multiplies the layer's light; what it absorbs does not pass to other layers */
  VLR_FACTOR_LEVEL = 4
};

/* Correction of steep mapped normals, which would show impossible reflections. */
enum {
  /* Normals are rotated as far as mirror images need to stay above the surface, and diffuse light fades out before the
   * surface's own horizon, as in Cycles of Blender 3 */
  VLR_RELIEF_TURNED = 0,
  VLR_RELIEF_FADED = 1,    /* the same, but normals of diffuse layers are kept; Blender 4 */
  VLR_RELIEF_SHADOWED = 2, /* the same, but diffuse light fades out as GGX facets shadow each other; Blender 5 */
  VLR_RELIEF_AS_IT_IS = 3  /* no correction */
};

typedef struct vlr_layer_desc {
  uint32_t struct_size;
  int32_t kind;                            /* VLR_LAYER_* */
  const vlr_principled_desc* surface;      /* NULL: its defaults; alpha and emission are ignored */
  const vlr_principled_textures* textures; /* NULL: none; only those that the kind uses */
  const vlr_texture* normal; /* reflecting layers: a normal map, colors, which follows the MikkTSpace tangents of the
                                mesh's relief_uvs, or a program's normal; NULL: none */
  float normal_map[6];       /* as those of vlr_principled_textures */
  float normal_strength;     /* scale of its tilt, not negative; 1 */
  uint32_t normal_set;       /* as those of vlr_principled_textures */
  int32_t normal_correction; /* VLR_RELIEF_* */
  int32_t interreflection;   /* diffuse layer: 1: its facets scatter light to each other, so energy is conserved; 0 */
  const vlr_texture* coat_normal; /* principled layer: like `normal`, of the coat alone; NULL: the surface's own */
  float coat_normal_map[6];
  float coat_normal_strength;
  uint32_t coat_normal_set;
} vlr_layer_desc;
VLR_API void vlr_layer_desc_init(vlr_layer_desc* desc);
typedef struct vlr_factor_desc {
  uint32_t struct_size;
  int32_t kind;               /* VLR_FACTOR_* */
  float value;                /* 1 */
  uint32_t set;               /* as those of vlr_principled_textures */
  const vlr_texture* texture; /* instead of value: numbers; instead of color: colors; NULL: none */
  float map[6];               /* as those of vlr_principled_textures */
  float color[3];             /* VLR_FACTOR_TINT: working space; 1, 1, 1 */
  /* VLR_FACTOR_LEVEL, ascending: the share is 1 where the number is level[1] and falls linearly to 0 at the others,
   * which are the levels of the neighbors; if one of them equals level[1], the share is 1 on its side */
  float level[3];
} vlr_factor_desc;
VLR_API void vlr_factor_desc_init(vlr_factor_desc* desc);
/* A layer of measured reflectance: exactly one of a model, a raw measurement and a BTF. Their colors are Rec. 709. */
typedef struct vlr_measured_layer_desc {
  uint32_t struct_size;
  uint32_t neighbors;                 /* as those of vlr_scene_add_model_material */
  const vlr_model* model;             /* of a BRDF or a BTF; with a measurement: sampled from, NULL: made here */
  const vlr_measurement* measurement; /* reference mode */
  const vlr_btf* btf;                 /* reference mode */
  uint64_t most_bytes;                /* of a BTF: as those of vlr_scene_add_btf_material */
  /* From the surface's texture coordinates (set 0, as placed by the instance) to the layer's, as those of
   * vlr_principled_textures: places a BTF, and turns it or an anisotropic BRDF with it. The identity for models with a
   * silhouette (VOTF) */
  float map[6];
  const vlr_texture* normal; /* as those of vlr_layer_desc, down to the end */
  float normal_map[6];
  float normal_strength;
  uint32_t normal_set;
  int32_t normal_correction;
  /* Numbers by point of the surface, as those of vlr_principled_textures, which also move the layer; NULL: none. After
   * `map`, tiles are rotated counterclockwise about the origin of their coordinates (radians) and enlarged (at least
   * 0.001 times) */
  float aspect; /* width of a tile divided by its height; 1 */
  const vlr_texture* rotation;
  const vlr_texture* scale;
  float rotation_map[6];
  float scale_map[6];
  uint32_t rotation_set;
  uint32_t scale_set;
} vlr_measured_layer_desc;
VLR_API void vlr_measured_layer_desc_init(vlr_measured_layer_desc* desc);

/* Creates a shader: the sum of its layers. A mix consists of layers whose weights add up to 1. */
VLR_API vlr_status vlr_shader_create(vlr_shader** out);
VLR_API void vlr_shader_free(vlr_shader* shader);
/* Adds a layer with a weight of 1. */
VLR_API vlr_status vlr_shader_add_layer(vlr_shader* shader, const vlr_layer_desc* desc);
/* The same for a measured layer. A silhouette (VOTF) of its model becomes that of the material, which can have only
 * one. Models, measurements and BTFs may be freed afterwards. */
VLR_API vlr_status vlr_shader_add_measured_layer(vlr_shader* shader, const vlr_measured_layer_desc* desc);
/* Multiplies the weight of the layer added last. */
VLR_API vlr_status vlr_shader_weigh_layer(vlr_shader* shader, const vlr_factor_desc* desc);
/* Adds a material of the layers so far; the shader may be freed or extended afterwards. Measured layers are converted
 * to the working space that the scene has now. */
VLR_API vlr_status vlr_scene_add_shader_material(vlr_scene* scene, const vlr_shader* shader, uint32_t* material);

/* ---- tiles: procedural mesostructure ------------------------------------------------------------------------- */

/* One period of a small structure, repeated infinitely in x and y: weaves, knit, net, chain mail, gravel, corduroy,
 * velvet, leather (vlr_tile_kinds_json). The cell is [0, period x] x [0, period y], meters, +z up. Parts that cross its
 * border are there once, whole, and stick out; copies shifted by the period complete the structure. The same options
 * give the same arrays.
 *
 * The pitch, size / count, is the distance between neighboring yarns, cords, rings or wales (for pebbles, about). */
typedef struct vlr_tile_options {
  uint32_t struct_size;
  uint32_t count;      /* pitches along a side of the cell; 0: the kind's default, as everywhere below */
  const char* kind;    /* a kind of vlr_tile_kinds_json; "weave" */
  double size;         /* side of the cell in meters; negative: the kind's default, as everywhere below */
  double thickness;    /* pitches: height of a yarn, cord or rib, diameter of a wire, depth of a bed of gravel */
  double gap;          /* pitches: between neighboring yarns, cords or ribs; kinds without a gap accept only 0 */
  double irregularity; /* 0..1: how far parts shrink, here and there, from their ideal shape */
  uint32_t resolution; /* points around a yarn, wire, pebble or rib; even. Triangles grow with its square */
  uint32_t pad;
  uint64_t seed;
} vlr_tile_options;
VLR_API void vlr_tile_options_init(vlr_tile_options* options);
/* JSON: kinds [{name, summary, defaults {size, count, resolution, thickness, gap, irregularity}}], in display order; a
 * kind has no default for options that it does not take. The text belongs to the library. */
VLR_API vlr_status vlr_tile_kinds_json(const char** json);
VLR_API vlr_status vlr_tile_create(const vlr_tile_options* options, vlr_tile** out);
VLR_API void vlr_tile_free(vlr_tile* tile);
/* The mesh, with normals, texture coordinates and slots, ready for vlr_scene_add_mesh; the arrays belong to the handle.
 * Set desc->struct_size first. */
VLR_API vlr_status vlr_tile_desc(const vlr_tile* tile, vlr_mesh_desc* desc);
/* The default material of slot `slot`. Colors are linear Rec. 709. Set material->struct_size first. */
VLR_API vlr_status vlr_tile_material(const vlr_tile* tile, uint32_t slot, vlr_principled_desc* material);
/* JSON: kind, period [x, y] (meters), heights [lowest, highest] (meters), open (a vertical line may hit nothing),
 * open_area (share of such lines; null: not known in closed form), vertices, triangles, shape (the keys of defaults,
 * and seed), materials [{name, base_color, metallic, roughness, specular}], one per slot. */
VLR_API vlr_status vlr_tile_info_json(vlr_tile* tile, const char** json);

/* ---- capture of tiles ---------------------------------------------------------------------------------------- */

enum { VLR_SIDES_AUTOMATIC = 0, VLR_SIDES_ONE = 1, VLR_SIDES_TWO = 2 };

/* Directions are pairs (theta, phi) in degrees: theta from the normal of the reference plane, beyond 90 below it. */
typedef struct vlr_capture_options {
  uint32_t struct_size;
  uint32_t texels[2]; /* along x and y */
  uint32_t samples;   /* paths per texel and view */
  uint32_t bounces;   /* further surfaces that a path hits */
  int32_t sides;      /* VLR_SIDES_*: two adds the mirror images of all directions; automatic: if the tile is open */
  uint32_t threads;   /* 0: all */
  int32_t resume;     /* 1: continue with the views of this same capture in the folder */
  uint64_t seed;
  const double* views;  /* [view_count x 2]; NULL: the library's 105, rings to 85 degrees */
  const double* lights; /* [light_count x 2]; NULL: likewise */
  uint64_t view_count, light_count;
  double origin[2];        /* of the cell, in scene units */
  double period[2];        /* both 0: the bounding box of the geometry, including its origin */
  double metres_per_unit;  /* 0: unknown */
  double reference_height; /* scene's z of the reference plane; NaN: chosen by least variance over views */
  uint64_t memory_limit;   /* bytes of the images of a view; larger ones lie in a file in the folder */
  const char* source;      /* name of the captured tile */
  int32_t measure_ray_share;
  uint32_t held_out; /* not 0: number of held-out pairs, up to 75 degrees, captured instead of views and lights */
} vlr_capture_options;
VLR_API void vlr_capture_options_init(vlr_capture_options* options);
/* Angles of a set of directions: [*count x 2] degrees. `name`: "81" (Bonn's), "105" (the same and a ring at 85
 * degrees), or another number of directions of equal solid angle. Call it first with angles NULL to get the count. */
VLR_API vlr_status vlr_directions(const char* name, double* angles, uint64_t* count);
/* Captures the committed scene `tile`, repeated by the period, into the folder `path`. JSON: seconds, rays,
 * rays_per_second, ray_share (or null), bytes, views, lights, pairs, views_resumed, sides, open, thickness,
 * reference_height (meters, or tile widths, over its lowest point), warning_codes. The scene must not change as long as
 * the job exists. */
VLR_API vlr_status vlr_capture_create_job(const vlr_scene* tile, const vlr_capture_options* options, const char* path,
                                          vlr_job** out);

/* ---- occlusion of tiles (VOTF) --------------------------------------------------------------------------------- */

typedef struct vlr_votf_options {
  uint32_t struct_size;
  uint32_t texels;         /* along x, at the same resolution along y and z */
  uint32_t threads;        /* 0: all */
  uint32_t check_views;    /* random views up to 75 degrees in which the result is compared with rays; 0: none */
  uint64_t seed;           /* of the check views */
  double origin[2];        /* of the cell, in scene units */
  double period[2];        /* both 0: the bounding box of the geometry, including its origin */
  double metres_per_unit;  /* 0: unknown */
  double surface;          /* scene's z that will lie on the carrying surfaces */
  double reference_height; /* scene's z of the plane of a BTF's texels; NaN: that of a capture of the model's sides */
  const char* source;      /* name of the captured tile */
} vlr_votf_options;
VLR_API void vlr_votf_options_init(vlr_votf_options* options);
/* Adds the VOTF of the committed scene `tile`, repeated by the period, to a copy of `model`: surfaces with the result
 * show its silhouette and holes. An existing VOTF is replaced. Result: a model. JSON: source, bytes, points [x, y, z],
 * heights [lowest, highest] (tile widths), tile_width (or null), closed, coverage, wrong (both null without
 * check_views), seconds, warning_codes. The scene must not change as long as the job exists. */
VLR_API vlr_status vlr_votf_create_job(const vlr_scene* tile, const vlr_model* model, const vlr_votf_options* options,
                                       vlr_job** out);
/* Computes the VOTF from the views of a BTF, without the geometry: coverage and heights of a capture, or the alpha of
 * images. Uses of `options` texels (0: those of the data), threads, check_views (views of the data, evenly spread;
 * `wrong` is the mean difference in coverage), surface (its height over the structure's lowest point, in meters, or in
 * tile widths if the tile's size is unknown) and source. Fails with VLR_UNSUPPORTED if the data have no coverage of the
 * structure. */
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
  VLR_STRATEGY_PRODUCT = 8, /* lobes of the material times lobes of the environment, besides both */
  /* The dissertation's method: for per-view models the interpolated densities of the nearest views (`neighbors`, or 4),
   * for others as SRBF; independent random numbers, regardless of `sequence`. MIS: half of the directions from the
   * lights. */
  VLR_STRATEGY_DISSERTATION = 9,
  VLR_STRATEGY_MIS_DISSERTATION = 10,
  /* MIS or PRODUCT and the share of the lights, for each material what a pilot of up to 2048 pixels found best; MIS
   * where an image is so small that a pilot would take more than a twenty-fifth of its time, and in the viewport. */
  VLR_STRATEGY_AUTO = 11
};

enum { VLR_HEURISTIC_BALANCE = 0, VLR_HEURISTIC_POWER = 1 };
enum { VLR_SEQUENCE_RANDOM = 0, VLR_SEQUENCE_SOBOL = 1, VLR_SEQUENCE_INDEPENDENT = 2 };

/* Bits: passes in addition to "Combined", "Depth", "Normal" and "Sample Count", which every image has; with the number
 * of channels. */
enum {
  VLR_PASS_POSITION = 1,        /* "Position" 3: in world space, of the first camera ray of a pixel, like depth */
  VLR_PASS_UV = 2,              /* "UV" 3: mean; the third is the share of the pixel with texture coordinates */
  VLR_PASS_OBJECT_INDEX = 4,    /* "IndexOB" 1: of the first camera ray */
  VLR_PASS_MATERIAL_INDEX = 8,  /* "IndexMA" 1: likewise */
  VLR_PASS_MIST = 16,           /* "Mist" 1: 0..1, mean */
  VLR_PASS_ALBEDO = 32,         /* "Albedo" 3: share of light reflected to the viewer, 0..1, working space, mean */
  VLR_PASS_ERROR = 64,          /* "Error" 3: standard error of "Combined", as if camera rays were independent */
  VLR_PASS_CRYPTO_OBJECT = 128, /* "CryptoObject00", "CryptoObject01", ... 4: two ids, each followed by its coverage */
  VLR_PASS_CRYPTO_MATERIAL = 256, /* "CryptoMaterial00", ...: likewise */
  VLR_PASS_CRYPTO_ASSET = 512,    /* "CryptoAsset00", ...: likewise */
  VLR_PASS_DENOISING_ALBEDO =
      1024,               /* "Denoising Albedo" 3: albedo plus emission of surfaces and environment; may exceed 1 */
  VLR_PASS_HALVES = 2048, /* "Halves" 18: means of color, denoising albedo and normal (3 each) over the even camera
                             rays, then over the odd ones */
  /* "Vector" 4: motion of what is seen, in pixels, x to the right and y up: its place when the shutter opens minus that
   * in the middle, then the latter minus that when it closes; mean over the camera rays that hit something. */
  VLR_PASS_VECTOR = 4096
};

typedef struct vlr_instance_label {
  float index;     /* "IndexOB" */
  float object_id; /* from vlr_cryptomatte_id; 0: none */
  float asset_id;
  int32_t uv_set; /* set of the mesh's texture coordinates that "UV" shows; -1: none */
} vlr_instance_label;
typedef struct vlr_material_label {
  float index; /* "IndexMA" */
  float id;    /* from vlr_cryptomatte_id; 0: none */
} vlr_material_label;

typedef struct vlr_pass_options {
  uint32_t struct_size;
  uint32_t asked;             /* VLR_PASS_* */
  uint32_t cryptomatte_ranks; /* ids per pixel, two per pass; 2..16; 6 */
  float mist_start;           /* meters from the camera; 5 */
  float mist_depth;           /* meters from there to full mist; 0: no mist; 25 */
  float mist_exponent;        /* exponent of that share: 1 linear, 2 quadratic, 0.5 inverse quadratic; 2 */
  /* Indexed like the scene's instances and materials; those beyond the arrays have no index, id or texture
   * coordinates. */
  const vlr_instance_label* instances;
  uint64_t instance_count;
  const vlr_material_label* materials;
  uint64_t material_count;
} vlr_pass_options;
VLR_API void vlr_pass_options_init(vlr_pass_options* options);
/* Hash of a UTF-8 name: MurmurHash3_x86_32 with seed 0, and its bits as the float that the Cryptomatte specification
 * derives from them. Each may be NULL. */
VLR_API vlr_status vlr_cryptomatte_id(const char* name, uint32_t* hash, float* id);

typedef struct vlr_render_options {
  uint32_t struct_size;
  uint32_t width, height;
  uint32_t spp;     /* light directions per pixel; camera rays (spp / split): at most 2^24 */
  uint32_t split;   /* number of them that share one camera ray; 1..48; 8 */
  uint32_t bounces; /* indirect bounces; 0: direct illumination only */
  int32_t strategy; /* VLR_STRATEGY_* */
  uint32_t threads; /* 0: all */
  uint64_t seed;
  double time_limit;         /* seconds, 0: none; stops at a whole pass */
  int32_t transparent;       /* 1: rays that hit nothing leave alpha 0 */
  int32_t measure_ray_share; /* 1: record 1 tile in 16 and replay its rays */
  int32_t heuristic;         /* for VLR_STRATEGY_MIS and the environment: VLR_HEURISTIC_* */
  int32_t sequence;          /* VLR_SEQUENCE_* */
  double share;              /* for VLR_STRATEGY_MIS: share of the directions sampled from the lights; 0..1; 0.5 */
  double noise;              /* relative error at which a block of 16 x 16 pixels gets no more samples; 0: off */
  const char* cache_folder;  /* for fits of the environment (product), created if missing; NULL or "": none */
  int32_t hide_world;        /* 1: camera rays that hit nothing are black; `transparent` takes precedence */
  /* Parts of an image, for several machines; not with `noise`. Range [samples_begin, samples_end) of the spp light
   * directions of a pixel, end 0: to the last; multiples of split, or spp. The means of ranges, weighted by their
   * camera rays (split light directions each, fewer for the last of a pixel), equal the image up to rounding. */
  uint32_t samples_begin, samples_end;
  /* Pixels [x0, x1) x [y0, y1), row 0 at the bottom, of width x height; all 0: all. They have the same bits as in the
   * whole image, and passes contain only them. */
  uint32_t crop_x0, crop_y0, crop_x1, crop_y1;
  /* Cycles' settings against fireflies, with the same meaning. Each biases the image, which neither noise nor
   * block_noise reports. Maximum of the channels' mean that one sample may add: of light directly from emitters to the
   * first surface or the camera, and of all other light; 0: none. */
  float clamp_direct, clamp_indirect;
  float filter_glossy;         /* roughens lobes that paths reach by directions of a density below it; 0: none */
  int32_t reflective_caustics; /* 0: no microfacet lobes behind diffuse bounces; 1 */
  int32_t denoise; /* 1: the image can be denoised (vlr_denoise_create_job), and `noise` is the error of the whole
                      denoised image: the root of the bound (relmse_bound there). The film has VLR_PASS_HALVES */
  const vlr_pass_options* passes; /* copied; NULL: only those that every image has */
} vlr_render_options;
VLR_API void vlr_render_options_init(vlr_render_options* options);
/* JSON: seconds, rays, samples_per_second, ray_share (or null), stages, nan_samples, spp, passes, noise, spp_mean,
 * block_noise, blocks_unfinished (null without a noise target), sky (null, or for products the fit of the environment:
 * lobes, relative_l2, seconds, cached), pilot (null, or what VLR_STRATEGY_AUTO chose, means over its pixels: pixels,
 * products: share lit with them, light_share). */
VLR_API vlr_status vlr_render_create_job(const vlr_scene* scene, const vlr_render_options* options, vlr_job** out);

/* Reads the film so far, row 0 at the bottom. Passes and channels: "Combined" 4 (RGBA, premultiplied), "Depth" 1,
 * "Normal" 3 (world), "Sample Count" 1, and the requested VLR_PASS_*. `pixels` holds width x height x channels values,
 * those of the crop if there is one. May be called while the job runs. */
VLR_API vlr_status vlr_job_read_pass(const vlr_job* job, const char* pass, float* pixels, uint64_t count);

/* Reads a render's film as sums that another film of the same size and passes can add, to share the camera rays of an
 * image (samples_begin, samples_end) among several runs or machines. Copies `count` = width x height x per_pixel floats
 * to `sums` and returns per_pixel; either may be NULL. While the job runs, tiles differ in progress. */
VLR_API vlr_status vlr_job_read_sums(const vlr_job* job, float* sums, uint64_t count, uint32_t* per_pixel);
/* Adds such sums of camera rays: earlier ones to a job before it starts, which then adds its own, or later ones once it
 * is done. Not while it runs. Once the film has both added sums and camera rays of its own, which a new run would count
 * twice, vlr_job_start refuses with VLR_INVALID_STATE. */
VLR_API vlr_status vlr_job_add_sums(vlr_job* job, const float* sums, uint64_t count);

/* Denoises the image of a render whose options set `denoise` and which is not running: vlr_job_read_pass of that render
 * then has "Denoised" 4 (RGBA, premultiplied; the alpha of "Combined"), until it gets more samples. `threads` 0: all.
 * JSON: relmse, relmse_bound (estimated error of the denoised image, and a bound that holds for 95 of 100 images; null
 * if a pixel has fewer than two camera rays: docs/engine/strategies.md), noisy_share (0..1, share of the noisy image in
 * it), path of Open Image Denoise. VLR_UNSUPPORTED if that is missing. */
VLR_API vlr_status vlr_denoise_create_job(vlr_job* render, uint32_t threads, vlr_job** out);
/* Opens Open Image Denoise. JSON: version, path. VLR_UNSUPPORTED, with what was tried, if it is missing. */
VLR_API vlr_status vlr_denoiser_json(const char** json);
/* File of Open Image Denoise 2 to try before libOpenImageDenoise.so.2 beside this library and on the system's path;
 * NULL or "": none. No effect once one is open. */
VLR_API vlr_status vlr_set_denoiser_file(const char* path);

/* Asks a render to end soon, at a whole pass, with what it has: it is then done, and the spp of its report is the
 * number of light directions that every pixel has. From any thread; starting the job again clears the request. */
VLR_API vlr_status vlr_job_stop(vlr_job* job);

/* Creates a job of a progressive image for display: coarse at once, then finer, then less noisy; `noise`, `time_limit`,
 * samples, crop and passes are ignored. Started again after a cancel, the job continues where it was. The scene may
 * change while it does not run; then call vlr_progressive_restart before the next start. The job commits the scene. Its
 * report is {}. */
VLR_API vlr_status vlr_progressive_create_job(vlr_scene* scene, const vlr_render_options* options, vlr_job** out);
/* Makes the next start begin from scratch. Not while the job runs. */
VLR_API vlr_status vlr_progressive_restart(vlr_job* job);
typedef struct vlr_progressive_picture {
  uint32_t struct_size;
  uint32_t width, height; /* 0: no image yet */
  uint32_t samples;       /* light directions of every pixel at full size */
  uint64_t version;       /* increases with every visible change */
} vlr_progressive_picture;
/* Reads the image so far, RGBA, premultiplied, row 0 at the bottom: width x height x 4 values of the image, which is no
 * larger than the options requested. `pixels` has room for `count` values; NULL: only fills `picture`. May be called at
 * any time. */
VLR_API vlr_status vlr_progressive_read(const vlr_job* job, float* pixels, uint64_t count,
                                        vlr_progressive_picture* picture);

/* ---- observations -------------------------------------------------------------------------------------------- */

/* Scene usage of a material: the views and lights under which frames show it, with weights, and 1024 of its hits with
 * their light. Files are JSON (docs/reference/measurement_formats.md). An observation may be changed (merge) by one
 * thread at a time. */

/* Creates an observation of no frame, to merge into. */
VLR_API vlr_status vlr_observation_create(vlr_observation** out);
VLR_API vlr_status vlr_observation_load(const char* path, vlr_observation** out);
/* Writes atomically. */
VLR_API vlr_status vlr_observation_save(const vlr_observation* observation, const char* path);
VLR_API void vlr_observation_free(vlr_observation* observation);
/* Adds the frames of `other` to `into`. The result does not depend on the order of frames, except for the rounding of
 * sums. */
VLR_API vlr_status vlr_observation_merge(vlr_observation* into, const vlr_observation* other);
/* JSON: kind "observation", frames, camera_rays, hits, weight (of all hits, in camera rays), share (weight /
 * camera_rays), views [from, to] (degrees that a model reduced to it covers; null if nothing was seen), light_density
 * (1/sr; null: delta lights), hash; for a material that varies over the surface also surface {finest (width of the
 * finest look-ups, as a share of the tile's side with more texels), footprint [shares of the weight by that width, one
 * per octave from 2^-16 on], tile_share (share of the tile that was seen)}. */
VLR_API vlr_status vlr_observation_info_json(vlr_observation* observation, const char** json);

typedef struct vlr_observe_options {
  uint32_t struct_size;
  uint32_t width, height; /* of the image: their ratio shapes the grid of about 65,536 camera rays, their size
                             determines a ray's footprint on a varying material */
  uint32_t bounces;       /* as in the render */
  uint32_t threads;       /* 0: all */
  uint32_t pad;
  uint64_t seed;
} vlr_observe_options;
VLR_API void vlr_observe_options_init(vlr_observe_options* options);
/* Observes one material of a committed scene. Result: an observation of one frame. JSON: seconds, and the keys of
 * vlr_observation_info_json except kind. */
VLR_API vlr_status vlr_observe_create_job(const vlr_scene* scene, uint32_t material, const vlr_observe_options* options,
                                          vlr_job** out);
/* Share of the material's weight in `frame` that is outside the usage that a scene model was made for: seen from other
 * views or under more concentrated light; for a BTF, seen more finely than its finest texels, or from other views. 0
 * for a full model. */
VLR_API vlr_status vlr_model_out_of_domain(const vlr_model* model, const vlr_observation* frame, double* share);
/* The observation of a finished job, as a new handle. */
VLR_API vlr_status vlr_job_result_observation(const vlr_job* job, vlr_observation** out);

/* ---- tables for shaders --------------------------------------------------------------------------------------- */

/* The light of a scene's world for look-ups in a shader (docs/engine/realtime.md): averaged by the clipped cosine and
 * by Gaussian lobes, one level each, and the world itself. Takes the world as it is when the job is created.
 * cache_folder: as in vlr_render_options. threads, here and below: 0: all. JSON: lobes, relative_l2, seconds and cached
 * of the fit of the world's mixture; mixture: x, y, z, bandwidth, r, g, b of each lobe. */
VLR_API vlr_status vlr_light_map_create_job(const vlr_scene* scene, const char* cache_folder, uint32_t threads,
                                            vlr_job** out);
/* The lobes of a BRDF model at many views, which a shader sums up. JSON: isotropic, side, blends, lobes.
 * VLR_INVALID_ARGUMENT for models of BTFs. */
VLR_API vlr_status vlr_lobe_rows_create_job(const vlr_model* model, uint32_t threads, vlr_job** out);
/* The lobes of a Principled material, without emission and alpha. JSON: as vlr_lobe_rows_create_job. */
VLR_API vlr_status vlr_principled_rows_create_job(const vlr_principled_desc* desc, uint32_t threads, vlr_job** out);
/* An SRBF model of a BTF as maps of its coefficients and relief: for view and light above and, if the BTF has its own,
 * below; the table stacks the `layers` of each side vertically. JSON: levels (x, width, height of each in a layer),
 * sides (of each layers, terms (of each coefficient light, view, half, phase, in_tile, color), bottom, top), aspect,
 * root. VLR_INVALID_ARGUMENT for other models. */
VLR_API vlr_status vlr_btf_maps_create_job(const vlr_model* model, vlr_job** out);
/* The VOTF of a model as a volume; the table stacks its `layers` vertically, the lowest first, each with a border of
 * one pixel: distance to the structure in tile widths, and its slope along x, y, z. JSON: layers, bottom, top,
 * reference (heights in widths), aspect, reach (the largest distance stored), open (whether rays can pass through).
 * VLR_INVALID_ARGUMENT for models without a VOTF, VLR_UNSUPPORTED for more than 2^23 pixels. */
VLR_API vlr_status vlr_shell_maps_create_job(const vlr_model* model, vlr_job** out);

/* ---- plots of models ----------------------------------------------------------------------------------------- */

enum {
  VLR_PLOT_LOBES = 0, /* luminance of f cos(theta_l) in the plane of incidence of one view, polar: the model, each of
                         its lobes, and the measurement */
  VLR_PLOT_ORDER = 1, /* error against lobes (BTFs: against bytes) with the chosen point */
  VLR_PLOT_VIEW_ERROR = 2, /* relative L2 at 5, 30, 60, 75 and 85 degrees, and the tolerance */
  VLR_PLOT_ALBEDO = 3,     /* directional albedo of each channel against the view angle: model and measurement */
  VLR_PLOT_OUTLINE = 4 /* share of the tile that its VOTF covers against the view angle: mean and range over azimuths */
};
/* Computes the numbers of a plot (VLR_PLOT_*). `measurement` adds measured data; NULL: none. `view` is the polar angle
 * of the view of VLR_PLOT_LOBES, 0 to below pi/2; `azimuth` its azimuth, and that of the views of VLR_PLOT_ALBEDO.
 * VLR_UNSUPPORTED with the reason if the model has no such plot: BTFs have VLR_PLOT_ORDER, and any model with a VOTF
 * VLR_PLOT_OUTLINE. */
VLR_API vlr_status vlr_plot_create(const vlr_model* model, const vlr_measurement* measurement, int32_t kind,
                                   double view, double azimuth, vlr_plot** out);
/* Computes a plot in the background; vlr_job_result_plot returns it. JSON: as vlr_plot_json. Albedo plots take
 * seconds. */
VLR_API vlr_status vlr_plot_create_job(const vlr_model* model, const vlr_measurement* measurement, int32_t kind,
                                       double view, double azimuth, vlr_job** out);
/* The plot of a finished job, as a new handle. */
VLR_API vlr_status vlr_job_result_plot(const vlr_job* job, vlr_plot** out);
VLR_API void vlr_plot_free(vlr_plot* plot);
/* JSON: plot ("lobes", "order", "view-error", "albedo", "outline"), polar, x and y {column, label, logarithmic, range
 * [low, high]}, series [{name, x [..], y [..], chosen (index of a point, or null)}]. Angles in degrees, f in 1/sr. */
VLR_API vlr_status vlr_plot_json(vlr_plot* plot, const char** json);

typedef struct vlr_plot_style {
  uint32_t struct_size;
  uint32_t side; /* pixels, 64..8192; 800 */
  float text;    /* em of the text in pixels, at most a sixteenth of the side; 0: derived from the side */
  /* sRGB, 0..1. Colors that would be unreadable on the background are moved towards the text's color. */
  float background[3];
  float foreground[3]; /* text and axes */
  float model[3];
  float measured[3]; /* also the chosen point */
  float red[3], green[3], blue[3];
} vlr_plot_style;
/* Defaults for white paper. */
VLR_API void vlr_plot_style_init(vlr_plot_style* style);
/* Draws RGBA of side x side, row 0 at the bottom: sRGB, 0..1, opaque. `count` is 4 side^2. */
VLR_API vlr_status vlr_plot_draw(const vlr_plot* plot, const vlr_plot_style* style, float* rgba, uint64_t count);
/* Format by extension, written atomically: .png and .svg are the same image, .csv has the numbers (series, x, y,
 * chosen). */
VLR_API vlr_status vlr_plot_save(const vlr_plot* plot, const vlr_plot_style* style, const char* path);

/* A line of UTF-8 text in the font of plots: coverage, 0..1, row 0 at the bottom; the baseline is a third of the height
 * above the bottom. `em` in pixels, 4..512. `width` and `height` are always set; `coverage` may be null, otherwise
 * `count` is width x height. */
VLR_API vlr_status vlr_text_draw(const char* utf8, float em, uint32_t* width, uint32_t* height, float* coverage,
                                 uint64_t count);

/* ---- images -------------------------------------------------------------------------------------------------- */

/* Writes linear pixels [height x width x channels], row 0 at the bottom, atomically. The extension selects the format:
 * .exr keeps floats, .png gets the sRGB curve and 8 bits. */
VLR_API vlr_status vlr_image_write(const char* path, uint32_t width, uint32_t height, uint32_t channels,
                                   const float* pixels);
/* Reads an image that Velour wrote: first the size (pixels NULL), then the pixels, row 0 at the bottom. OpenEXR: all
 * channels of the first part as they are stored, colors first; other files: as vlr_picture_read. */
VLR_API vlr_status vlr_image_read(const char* path, uint32_t* width, uint32_t* height, uint32_t* channels,
                                  float* pixels, uint64_t count);
/* Reads an OpenEXR, Radiance HDR, PNG, JPEG, TIFF or BMP image written by any program and recognized by its content: 1
 * to 4 channels (gray, gray and alpha, RGB, RGBA), upright, linear Rec. 709, row 0 at the bottom. First reads the size
 * (pixels NULL), then the pixels. +infinity becomes the largest finite value, NaN 0. */
VLR_API vlr_status vlr_picture_read(const char* path, const vlr_picture_options* options, uint32_t* width,
                                    uint32_t* height, uint32_t* channels, float* pixels, uint64_t count);
/* JSON list of warnings, {code, values}: the parts of the file that are left out, and the statements of its header that
 * are not followed. `path` NULL: those of the thread's last vlr_picture_read with pixels, and about values that it
 * replaced. The text belongs to the thread until its next call. */
VLR_API vlr_status vlr_picture_notes_json(const char* path, const vlr_picture_options* options, const char** json);
/* Position of the pixels of an OpenEXR file in a larger image (its data window in its display window). */
typedef struct vlr_image_frame {
  uint32_t struct_size;
  uint32_t width, height; /* of the larger image */
  int32_t x, y;           /* of the lower left pixel, from the larger image's lower left corner */
} vlr_image_frame;
/* Like vlr_image_write, for .exr only, with such a frame (NULL: an image of its own) and texts in the header: `texts`
 * holds text_count names, each followed by its text. */
VLR_API vlr_status vlr_image_write_part(const char* path, uint32_t width, uint32_t height, uint32_t channels,
                                        const float* pixels, const vlr_image_frame* frame, const char* const* texts,
                                        uint32_t text_count);
/* Header of an OpenEXR file as JSON: width, height, channels [names, in the order of vlr_image_read], frame {width,
 * height, x, y}, texts {name: text}, multi_part (whether there are further parts, which are not described). The text
 * belongs to the thread until its next call. */
VLR_API vlr_status vlr_image_header_json(const char* path, const char** json);
/* rmse and relmse of linear RGB: relmse = mean((x - r)^2 / (r^2 + 0.01 mean(r)^2)). Pixel counts must agree. */
VLR_API vlr_status vlr_image_compare(uint64_t pixel_count, uint32_t channels, const float* pixels,
                                     const float* reference, double* rmse, double* relmse);

#ifdef __cplusplus
}
#endif
#endif
