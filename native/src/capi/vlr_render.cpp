#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/reports/reports.h"
#include "denoise/denoiser.h"
#include "render/film/cryptomatte.h"
#include "render/film/film.h"
#include "render/film/noise_target.h"
#include "render/film/pass_layout.h"
#include "render/preparation.h"
#include "render/render.h"

using namespace velour;
using namespace velour::capi;

void vlr_render_options_init(vlr_render_options* options) {
  const RenderOptions defaults;
  *options = {};
  options->struct_size = sizeof(vlr_render_options);
  options->width = static_cast<uint32_t>(defaults.width);
  options->height = static_cast<uint32_t>(defaults.height);
  options->spp = static_cast<uint32_t>(defaults.spp);
  options->split = static_cast<uint32_t>(defaults.split);
  options->bounces = static_cast<uint32_t>(defaults.bounces);
  options->strategy = static_cast<int32_t>(defaults.strategy);
  options->heuristic = static_cast<int32_t>(defaults.heuristic);
  options->sequence = static_cast<int32_t>(defaults.sequence);
  options->share = static_cast<double>(defaults.light_share);
  options->clamp_direct = defaults.light_paths.clamp_direct;
  options->clamp_indirect = defaults.light_paths.clamp_indirect;
  options->filter_glossy = defaults.light_paths.filter_glossy;
  options->reflective_caustics = defaults.light_paths.reflective_caustics ? 1 : 0;
}

namespace {

/// `given` NULL: no passes. Throws Error(invalid_argument, version_mismatch).
PassOptions passes_of(const vlr_pass_options* given) {
  const vlr_pass_options asked = read_options(given, vlr_pass_options_init, "vlr_pass_options");
  if (asked.instance_count > 0) require(asked.instances, "vlr_pass_options.instances");
  if (asked.material_count > 0) require(asked.materials, "vlr_pass_options.materials");
  PassOptions options;
  options.asked = asked.asked;
  options.cryptomatte_ranks = static_cast<int>(asked.cryptomatte_ranks);
  options.mist = {asked.mist_start, asked.mist_depth, asked.mist_exponent};
  for (uint64_t i = 0; i < asked.instance_count; ++i) {
    const vlr_instance_label& label = asked.instances[i];
    options.instances.push_back({label.index, label.object_id, label.asset_id, label.uv_set});
  }
  for (uint64_t i = 0; i < asked.material_count; ++i) {
    options.materials.push_back({asked.materials[i].index, asked.materials[i].id});
  }
  return options;
}

RenderOptions converted(const vlr_render_options& given) {
  if (given.strategy < VLR_STRATEGY_UNIFORM || given.strategy > static_cast<int32_t>(kLastStrategy)) {
    throw Error(Status::invalid_argument,
                "vlr_render_options.strategy is " + std::to_string(given.strategy) + ", not a VLR_STRATEGY value.");
  }
  constexpr uint32_t kLargest = 65536;
  if (given.width == 0 || given.height == 0 || given.width > kLargest || given.height > kLargest) {
    throw Error(Status::invalid_argument, "An image cannot have " + std::to_string(given.width) + " x " +
                                              std::to_string(given.height) + " pixels; each side must be 1 to " +
                                              std::to_string(kLargest) + ".");
  }
  RenderOptions options;
  options.width = static_cast<int>(given.width);
  options.height = static_cast<int>(given.height);
  options.spp = static_cast<int>(given.spp);
  options.split = static_cast<int>(given.split);
  options.bounces = static_cast<int>(given.bounces);
  options.strategy = static_cast<Strategy>(given.strategy);
  options.threads = static_cast<int>(given.threads);
  options.seed = given.seed;
  options.time_limit = given.time_limit;
  options.transparent = given.transparent != 0;
  options.hide_world = given.hide_world != 0;
  options.measure_ray_share = given.measure_ray_share != 0;
  options.heuristic = static_cast<Heuristic>(given.heuristic);
  options.sequence = static_cast<Sequence>(given.sequence);
  options.light_share = static_cast<float>(given.share);
  options.light_paths = {given.clamp_direct, given.clamp_indirect, given.filter_glossy, given.reflective_caustics != 0};
  options.noise = given.noise;
  options.denoise = given.denoise != 0;
  options.samples = {static_cast<int>(given.samples_begin), static_cast<int>(given.samples_end)};
  options.crop = {static_cast<int>(given.crop_x0), static_cast<int>(given.crop_y0), static_cast<int>(given.crop_x1),
                  static_cast<int>(given.crop_y1)};
  if (given.cache_folder) options.cache_folder = given.cache_folder;
  return options;
}

}  // namespace

vlr_status vlr_render_create_job(const vlr_scene* scene, const vlr_render_options* options, vlr_job** out) {
  return guard([&] {
    require(scene, "scene");
    require(out, "out");
    if (!scene->scene->committed()) {
      throw Error(Status::invalid_state, "The scene is not committed; call vlr_scene_commit first.");
    }
    const vlr_render_options given = read_options(options, vlr_render_options_init, "vlr_render_options");
    const RenderOptions asked = converted(given);
    check_crop(asked);
    PassOptions passes = passes_of(given.passes);
    if (asked.denoise) passes.asked |= pass::kHalves;
    auto film = std::make_shared<Film>(asked.window(), std::move(passes));
    auto output = std::make_shared<JobOutput>();
    output->film = film;
    const auto task = [output, film, asked, source = std::shared_ptr<const Scene>(scene->scene)](Progress& progress) {
      RenderOptions options_of_run = asked;
      options_of_run.stop = &output->stop;
      options_of_run.onto_film = output->onto_film;
      output->rendered = true;
      output->set(render_json(render(*source, options_of_run, *film, progress)));
    };
    *out = new vlr_job(output, task);
  });
}

vlr_status vlr_job_stop(vlr_job* job) {
  return guard([&] {
    require(job, "job");
    if (!job->output->film)
      throw Error(Status::invalid_state, "This job is not a render, so it cannot be stopped with a result; cancel it.");
    job->output->stop = true;
  });
}

namespace {

Film& film_of(const vlr_job* job) {
  require(job, "job");
  if (!job->output->film) throw Error(Status::invalid_state, "This job does not render an image.");
  return *job->output->film;
}

}  // namespace

vlr_status vlr_job_read_sums(const vlr_job* job, float* sums, uint64_t count, uint32_t* per_pixel) {
  return guard([&] {
    const Film& film = film_of(job);
    if (per_pixel) *per_pixel = static_cast<uint32_t>(sums_per_pixel(film));
    if (sums) read_sums(film, {sums, static_cast<size_t>(count)});
  });
}

vlr_status vlr_job_add_sums(vlr_job* job, const float* sums, uint64_t count) {
  return guard([&] {
    Film& film = film_of(job);
    require(sums, "sums");
    if (job->job.poll().state == Job::State::running) {
      throw Error(Status::invalid_state, "The job is running; add sums before it starts or after it has ended.");
    }
    add_sums({sums, static_cast<size_t>(count)}, film);
    job->output->onto_film = true;
  });
}

vlr_status vlr_progressive_create_job(vlr_scene* scene, const vlr_render_options* options, vlr_job** out) {
  return guard([&] {
    require(scene, "scene");
    require(out, "out");
    const RenderOptions asked = converted(read_options(options, vlr_render_options_init, "vlr_render_options"));
    auto output = std::make_shared<JobOutput>();
    output->progressive = std::make_shared<ProgressiveRender>(scene->scene, asked);
    *out = new vlr_job(output, [output](Progress& progress) {
      output->progressive->run(progress);
      output->set("{}");
    });
  });
}

namespace {

ProgressiveRender& progressive_of(const vlr_job* job) {
  require(job, "job");
  if (!job->output->progressive) throw Error(Status::invalid_state, "This job is not a progressive render.");
  return *job->output->progressive;
}

}  // namespace

vlr_status vlr_progressive_restart(vlr_job* job) {
  return guard([&] {
    ProgressiveRender& progressive = progressive_of(job);
    if (job->job.poll().state == Job::State::running) {
      throw Error(Status::invalid_state, "The job is running; cancel it and wait for it to end first.");
    }
    progressive.restart();
  });
}

vlr_status vlr_progressive_read(const vlr_job* job, float* pixels, uint64_t count, vlr_progressive_picture* picture) {
  return guard([&] {
    const ProgressiveRender& progressive = progressive_of(job);
    const auto seen = pixels ? progressive.read({pixels, static_cast<size_t>(count)}) : progressive.picture();
    const vlr_progressive_picture values{sizeof(vlr_progressive_picture), static_cast<uint32_t>(seen.width),
                                         static_cast<uint32_t>(seen.height), seen.samples, seen.version};
    write_struct(values, picture, "vlr_progressive_picture");
  });
}

vlr_status vlr_job_read_pass(const vlr_job* job, const char* pass, float* pixels, uint64_t count) {
  return guard([&] {
    const Film& film = film_of(job);
    require(pass, "pass");
    require(pixels, "pixels");
    const uint64_t expected = static_cast<uint64_t>(film.width()) * static_cast<uint64_t>(film.height()) *
                              static_cast<uint64_t>(Film::channels(pass));
    if (count != expected) {
      throw Error(Status::invalid_argument, std::string("Pass '") + pass + "' has " + std::to_string(expected) +
                                                " values, but count is " + std::to_string(count) + ".");
    }
    film.read_pass(pass, {pixels, static_cast<size_t>(count)});
  });
}

void vlr_pass_options_init(vlr_pass_options* options) {
  const PassOptions defaults;
  *options = {};
  options->struct_size = sizeof(vlr_pass_options);
  options->cryptomatte_ranks = static_cast<uint32_t>(defaults.cryptomatte_ranks);
  options->mist_start = defaults.mist.start;
  options->mist_depth = defaults.mist.depth;
  options->mist_exponent = defaults.mist.exponent;
}

vlr_status vlr_cryptomatte_id(const char* name, uint32_t* hash, float* id) {
  return guard([&] {
    require(name, "name");
    if (hash != nullptr) *hash = murmur_hash(name);
    if (id != nullptr) *id = cryptomatte_id(name);
  });
}

namespace {

std::string denoised_json(const Film& film) {
  const OpenImageDenoise& oidn = open_image_denoise();
  const auto error = film.denoised_error();
  return text({{"relmse", error ? Json(error->relmse) : Json(nullptr)},
               {"relmse_bound", error ? Json(error->bound()) : Json(nullptr)},
               {"noisy_share", error ? error->noisy_share : 0.0},
               {"path", oidn.library.path()}});
}

}  // namespace

vlr_status vlr_denoise_create_job(vlr_job* render, uint32_t threads, vlr_job** out) {
  return guard([&] {
    require(render, "render");
    require(out, "out");
    const std::shared_ptr<Film> film = render->output->film;
    if (!film || !film->options().has(pass::kHalves)) {
      throw Error(
          Status::invalid_argument,
          "The image of this job cannot be denoised: the job was created without vlr_render_options.denoise. Set it.");
    }
    if (render->job.poll().state == Job::State::running) {
      throw Error(Status::invalid_state, "The render is still running; wait for its end before denoising.");
    }
    auto output = std::make_shared<JobOutput>();
    *out = new vlr_job(output, [output, film, threads](Progress& progress) {
      progress.stage("denoising", 0.0, 1.0);
      denoise(*film, static_cast<int>(threads), progress);
      output->set(denoised_json(*film));
    });
  });
}

vlr_status vlr_denoiser_json(const char** json) {
  return guard([&] {
    require(json, "json");
    const Denoiser denoiser(1);
    thread_local std::string result;
    result = text({{"version", denoiser.version()}, {"path", denoiser.path()}});
    *json = result.c_str();
  });
}

vlr_status vlr_set_denoiser_file(const char* path) {
  return guard([&] { set_open_image_denoise_file(path != nullptr ? path : ""); });
}
