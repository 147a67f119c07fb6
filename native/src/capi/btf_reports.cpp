#include "capi/btf_reports.h"

#include <algorithm>

#include "capi/json_text.h"
#include "capi/model_reports.h"
#include "capi/scene_reports.h"
#include "model/order_json.h"

namespace velour::capi {
namespace {

double largest_theta(const std::vector<PolarAngles>& directions) {
  double largest = 0;
  for (const PolarAngles& d : directions) largest = std::max(largest, d.theta);
  return largest;
}

Json shell_json(const std::optional<Shell>& shell) {
  if (!shell) return nullptr;
  return {{"thickness", shell->thickness}, {"reference_height", shell->reference_height}};
}

Json entries_json(const CountedPairs& counted) {
  return {{"pairs", counted.pairs},
          {"values", counted.counts.values},
          {"not_finite", counted.counts.not_finite},
          {"negative", counted.counts.negative}};
}

}  // namespace

std::string btf_json(const BtfMeasurement& btf) {
  const PairLayout& layout = btf.layout();
  Json json = source_json("btf", btf.provenance());
  json.update(
      Json{{"raw_bytes", btf.raw_bytes()},
           {"texels", {btf.grid().width, btf.grid().height}},
           {"views", layout.views().size()},
           {"lights", layout.lights().size()},
           {"pairs", layout.pairs()},
           {"complete", layout.complete()},
           {"largest_theta", {{"view", largest_theta(layout.views())}, {"light", largest_theta(layout.lights())}}},
           {"tile_metres", tile_json(btf.grid())},
           {"shell", shell_json(btf.shell())},
           {"errors", btf.has_errors()},
           {"structure", btf.has_structure()},
           {"entries", entries_json(count_values(btf))},
           {"details", details_json(btf)}});
  return text(json);
}

std::string btf_export_json(const BtfExportReport& report) {
  return text(
      {{"format", report.format}, {"pictures", report.pictures}, {"bytes", report.bytes}, {"seconds", report.seconds}});
}

std::string compression_json(const Model& model, uint64_t file_bytes) {
  const BtfRecord& record = model.btf.value();
  Json json = {{"method", record.method}};
  json.update(size_json(model, file_bytes));
  json.update(Json{{"ratio", static_cast<double>(record.raw_bytes) / static_cast<double>(file_bytes)},
                   {"psnr", record.psnr},
                   {"psnr_held_out", or_null(record.psnr_held_out)},
                   {"ser", record.ser},
                   {"relative_l2", record.relative_l2},
                   {"p99", record.p99},
                   {"evaluations_per_second", record.evaluations_per_second},
                   {"seconds", record.seconds},
                   {"warnings", record.warnings},
                   {"tolerance", record.tolerance},
                   {"order", order_json(record.order)},
                   {"search", trials_json(record.search)}});
  if (!record.shapes.empty()) json["shapes"] = shapes_json(record.shapes);
  if (model.scene) {
    json["texels"] = {grid_of(model)->width, grid_of(model)->height};
    json["scene"] = reduced_json(*model.scene);
  }
  return text(json);
}

std::string btf_errors_json(const BtfErrors& errors, double p99) {
  return text({{"psnr", errors.psnr},
               {"ser", errors.ser},
               {"relative_l2", errors.relative_l2},
               {"brightness", errors.brightness},
               {"p99", p99},
               {"pairs", errors.pairs}});
}

}  // namespace velour::capi
