#include "model/btf_record.h"

#include "file/json_fields.h"
#include "job/error.h"

namespace velour {

using Json = JsonFields::Json;

std::string btf_record_json(const BtfRecord& record) {
  Json json = {{"method", record.method},
               {"psnr", record.psnr},
               {"ser", record.ser},
               {"p99", record.p99},
               {"raw_bytes", record.raw_bytes},
               {"seconds", record.seconds},
               {"evaluations_per_second", record.evaluations_per_second},
               {"seed", record.seed},
               {"warnings", record.warnings}};
  if (record.psnr_held_out) json["psnr_held_out"] = *record.psnr_held_out;
  return json.dump();
}

BtfRecord parse_btf_record(const std::string& text, const std::string& where) {
  const JsonSource source{where, "the model file is damaged."};
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) throw Error(Status::bad_data, where + " is not a JSON object; " + source.remedy);
  const JsonFields fields(json, source);
  BtfRecord record;
  record.method = fields.text("method");
  record.psnr = fields.number("psnr");
  record.ser = fields.number("ser");
  record.p99 = fields.number("p99");
  record.raw_bytes = fields.whole("raw_bytes", uint64_t{1} << 53);
  record.seconds = fields.number("seconds");
  if (fields.has("evaluations_per_second")) record.evaluations_per_second = fields.number("evaluations_per_second");
  record.seed = fields.whole("seed", ~uint64_t{0});
  if (fields.has("psnr_held_out")) record.psnr_held_out = fields.number("psnr_held_out");
  for (const Json& warning : fields.at("warnings")) {
    if (!warning.is_string()) fields.fail("warnings", "a list of sentences");
    record.warnings.push_back(warning.get<std::string>());
  }
  return record;
}

}  // namespace velour
