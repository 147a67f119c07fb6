// Plots of models: numbers, pictures, files.
#include <algorithm>
#include <filesystem>

#include "base/file.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/reports/reports.h"
#include "image/picture.h"
#include "plot/font.h"
#include "plot/model_plots.h"
#include "plot/output.h"
#include "plot/pen.h"
#include "plot/plot.h"

using namespace velour;
using namespace velour::capi;

namespace {

constexpr size_t kMaxText = 1024;  // bytes of a line of text

Json axis_json(const PlotAxis& axis) {
  return {{"column", axis.column},
          {"label", axis.label},
          {"logarithmic", axis.logarithmic},
          {"range", {axis.low, axis.high}}};
}

Json series_json(const PlotSeries& series) {
  Json x = Json::array(), y = Json::array();
  for (const PlotPoint& p : series.points) x.push_back(p.x), y.push_back(p.y);
  return {{"name", series.name}, {"x", x}, {"y", y}, {"chosen", series.chosen ? Json(*series.chosen) : Json()}};
}

Json plot_json(const Plot& plot) {
  Json series = Json::array();
  for (const PlotSeries& s : plot.series) series.push_back(series_json(s));
  return {{"plot", plot.kind},
          {"polar", plot.polar},
          {"x", axis_json(plot.x)},
          {"y", axis_json(plot.y)},
          {"series", series}};
}

PlotKind kind_of(int32_t kind) {
  if (kind < 0 || kind >= static_cast<int32_t>(kPlotNames.size())) {
    throw Error(Status::invalid_argument, "kind is " + std::to_string(kind) + ", not a VLR_PLOT value.");
  }
  return static_cast<PlotKind>(kind);
}

void set(float (&to)[3], const Rgb& from) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

Rgb checked_color(const float (&from)[3], const char* name) {
  for (const float channel : from) {
    if (channel >= 0 && channel <= 1) continue;
    throw Error(Status::invalid_argument, std::string("vlr_plot_style.") + name + " has a channel of " +
                                              std::to_string(channel) + "; it must be 0 to 1.");
  }
  return {from[0], from[1], from[2]};
}

PlotStyle converted(const vlr_plot_style* given) {
  const vlr_plot_style style = read_options(given, vlr_plot_style_init, "vlr_plot_style");
  constexpr uint32_t kTooLarge = PlotStyle::kLargestSide + 1;  // refused like all larger ones, and within int
  return {.side = static_cast<int>(std::min(style.side, kTooLarge)),
          .text = style.text,
          .colors = {.background = checked_color(style.background, "background"),
                     .text = checked_color(style.foreground, "foreground"),
                     .model = checked_color(style.model, "model"),
                     .measured = checked_color(style.measured, "measured"),
                     .red = checked_color(style.red, "red"),
                     .green = checked_color(style.green, "green"),
                     .blue = checked_color(style.blue, "blue")}};
}

void write_text(const std::string& path, const std::string& text) {
  write_file(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

void write_png(const std::string& path, const Drawing& drawing) {
  Picture picture{drawing.side, drawing.side, 4, rasterized(drawing)};
  for (size_t i = 0; i < picture.pixels.size(); ++i) {
    if (i % 4 != 3) picture.pixels[i] = linear_from_srgb(picture.pixels[i]);  // as write_picture() expects
  }
  write_picture(path, picture);
}

}  // namespace

vlr_status vlr_plot_create(const vlr_model* model, const vlr_measurement* measurement, int32_t kind, double view,
                           double azimuth, vlr_plot** out) {
  return guard([&] {
    require(model, "model");
    require(out, "out");
    const auto measured = measurement ? kept(measurement->measurement) : nullptr;
    Progress unwatched;
    *out = new vlr_plot{make_plot(kind_of(kind), kept(model->model), measured.get(), {view, azimuth}, unwatched), {}};
  });
}

vlr_status vlr_plot_create_job(const vlr_model* model, const vlr_measurement* measurement, int32_t kind, double view,
                               double azimuth, vlr_job** out) {
  return guard([&] {
    require(model, "model");
    require(out, "out");
    const auto measured = measurement ? measurement->measurement : nullptr;
    auto output = std::make_shared<JobOutput>();
    const auto task = [output, measured, plotted = kind_of(kind), of = model->model,
                       at = PlotView{view, azimuth}](Progress& progress) {
      const auto plot = std::make_shared<const Plot>(make_plot(plotted, of, measured.get(), at, progress));
      output->set(text(plot_json(*plot)), plot);
    };
    *out = new vlr_job(output, task);
  });
}

vlr_status vlr_job_result_plot(const vlr_job* job, vlr_plot** out) {
  return guard([&] {
    require(job, "job");
    require(out, "out");
    job->job.rethrow();
    const std::lock_guard lock(job->output->mutex);
    if (!job->output->plot) throw Error(Status::invalid_state, "This job does not produce a plot.");
    *out = new vlr_plot{*job->output->plot, {}};
  });
}

void vlr_plot_free(vlr_plot* plot) { delete plot; }

vlr_status vlr_plot_json(vlr_plot* plot, const char** json) {
  return guard([&] {
    require(plot, "plot");
    require(json, "json");
    plot->json = text(plot_json(plot->plot));
    *json = plot->json.c_str();
  });
}

void vlr_plot_style_init(vlr_plot_style* style) {
  const PlotStyle defaults;
  *style = {};
  style->struct_size = sizeof(vlr_plot_style);
  style->side = static_cast<uint32_t>(defaults.side);
  style->text = defaults.text;
  set(style->background, defaults.colors.background);
  set(style->foreground, defaults.colors.text);
  set(style->model, defaults.colors.model);
  set(style->measured, defaults.colors.measured);
  set(style->red, defaults.colors.red);
  set(style->green, defaults.colors.green);
  set(style->blue, defaults.colors.blue);
}

vlr_status vlr_plot_draw(const vlr_plot* plot, const vlr_plot_style* style, float* rgba, uint64_t count) {
  return guard([&] {
    require(plot, "plot");
    require(rgba, "rgba");
    const std::vector<float> pixels = rasterized(lay_out(plot->plot, converted(style)));
    if (count != pixels.size()) {
      throw Error(Status::invalid_argument, "count is " + std::to_string(count) + ", but the image has " +
                                                std::to_string(pixels.size()) + " values.");
    }
    std::copy(pixels.begin(), pixels.end(), rgba);
  });
}

vlr_status vlr_plot_save(const vlr_plot* plot, const vlr_plot_style* style, const char* path) {
  return guard([&] {
    require(plot, "plot");
    require(path, "path");
    const std::string extension = std::filesystem::path(path).extension().string();
    if (extension == ".csv") return write_text(path, csv_text(plot->plot));
    if (extension != ".png" && extension != ".svg") {
      throw Error(Status::unsupported, std::string(path) + ": plots can only be written as .png, .svg or .csv.");
    }
    const Drawing drawing = lay_out(plot->plot, converted(style));
    extension == ".svg" ? write_text(path, svg_text(drawing)) : write_png(path, drawing);
  });
}

vlr_status vlr_text_draw(const char* utf8, float em, uint32_t* width, uint32_t* height, float* coverage,
                         uint64_t count) {
  return guard([&] {
    require(utf8, "utf8");
    require(width, "width");
    require(height, "height");
    const std::string_view text(utf8);
    if (!(em >= 4 && em <= 512)) {
      throw Error(Status::invalid_argument, "em is " + std::to_string(em) + "; it must be 4 to 512 pixels.");
    }
    if (text.size() > kMaxText) {
      throw Error(Status::invalid_argument, "utf8 has " + std::to_string(text.size()) + " bytes; the maximum is " +
                                                std::to_string(kMaxText) + ".");
    }
    const TextPixels pixels = text_pixels(text, em, 0);
    *width = static_cast<uint32_t>(pixels.width);
    *height = static_cast<uint32_t>(pixels.height);
    if (!coverage) return;
    if (count != pixels.coverage.size()) {
      throw Error(Status::invalid_argument, "count is " + std::to_string(count) + ", but the text has " +
                                                std::to_string(pixels.coverage.size()) + " pixels.");
    }
    const auto row = static_cast<size_t>(pixels.width);
    for (size_t i = 0; i < pixels.coverage.size(); ++i) {
      const size_t y = i / row, x = i % row;
      coverage[(*height - 1 - y) * row + x] = static_cast<float>(pixels.coverage[i]) / 255;
    }
  });
}
