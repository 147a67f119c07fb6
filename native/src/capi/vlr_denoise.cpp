#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/json_text.h"
#include "denoise/denoiser.h"
#include "render/denoised_target.h"

using namespace velour;
using namespace velour::capi;

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
