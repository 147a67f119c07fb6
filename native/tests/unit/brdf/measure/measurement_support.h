// What the tests of the readers share.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "brdf/measure/measurement.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"

namespace velour::test {

struct Value {
  Rgb f;
  bool valid;
};

inline Value eval_one(const Measurement& measurement, const Vec3& wl, const Vec3& wv) {
  Value value{};
  uint8_t valid = 2;
  measurement.eval(wv, {&wl, 1}, {&value.f, 1}, {&valid, 1});
  EXPECT_LE(valid, 1);
  value.valid = valid == 1;
  return value;
}

/// Pairs of the upper hemisphere, every second one near the mirror direction; never nearer to the horizon than `low`.
inline std::vector<DirectionPair> random_pairs(int count, uint64_t seed, float low = 0.02f) {
  std::vector<DirectionPair> pairs;
  RandomStream random(seed, 0, 0);
  while (static_cast<int>(pairs.size()) < count) {
    const Vec3 wv = sample_uniform_hemisphere(random.next2());
    Vec3 wl = sample_uniform_hemisphere(random.next2());
    if (pairs.size() % 2 == 1) wl = glm::normalize(Vec3(-wv.x, -wv.y, wv.z) + 0.1f * wl);
    if (wl.z > low && wv.z > low) pairs.push_back({wl, wv});
  }
  return pairs;
}

inline Vec3 rotated(const Vec3& w, float phi) {
  return {w.x * std::cos(phi) - w.y * std::sin(phi), w.x * std::sin(phi) + w.y * std::cos(phi), w.z};
}

/// An isotropic, reciprocal BRDF with a highlight: diffuse plus a Gaussian in the half angle.
inline Rgb glossy(const Vec3& wl, const Vec3& wv) {
  const Vec3 h = glm::normalize(wl + wv);
  const float tan_sq = (h.x * h.x + h.y * h.y) / (h.z * h.z);
  const float peak = std::exp(-tan_sq / 0.04f) * (0.5f + std::pow(1.0f - glm::dot(h, wl), 5.0f));
  return Rgb(0.05f, 0.1f, 0.2f) + Rgb(3.0f, 2.5f, 2.0f) * peak;
}

/// The sentence of the refusal, "" where `call` goes through.
inline std::string refusal(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

inline Provenance provenance_named(const std::string& path) {
  Provenance provenance;
  provenance.path = path;
  return provenance;
}

/// Builds the bytes of a .bsdf container.
class TensorFileBuilder {
 public:
  template <typename T>
  TensorFileBuilder& add(const std::string& name, uint8_t type, const std::vector<uint64_t>& shape,
                         const std::vector<T>& values) {
    std::vector<uint8_t> bytes(values.size() * sizeof(T));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    fields_.push_back({name, type, shape, bytes});
    return *this;
  }
  TensorFileBuilder& floats(const std::string& name, const std::vector<uint64_t>& shape,
                            const std::vector<float>& values) {
    return add(name, 10, shape, values);
  }
  TensorFileBuilder& remove(const std::string& name) {
    std::erase_if(fields_, [&](const Field& field) { return field.name == name; });
    return *this;
  }

  /// Bytes, and with `table_at` the position of each field's entry in the header (of its name's length).
  std::vector<uint8_t> bytes(std::map<std::string, size_t>* table_at = nullptr) const {
    size_t header = 18;
    for (const Field& field : fields_) header += 13 + field.name.size() + 8 * field.shape.size();
    std::vector<uint8_t> out;
    for (const char c : std::string("tensor_file")) out.push_back(static_cast<uint8_t>(c));
    out.insert(out.end(), {0, 1, 0});
    put(out, static_cast<uint32_t>(fields_.size()));
    uint64_t offset = header;
    for (const Field& field : fields_) {
      if (table_at) (*table_at)[field.name] = out.size();
      put(out, static_cast<uint16_t>(field.name.size()));
      out.insert(out.end(), field.name.begin(), field.name.end());
      put(out, static_cast<uint16_t>(field.shape.size()));
      out.push_back(field.type);
      put(out, offset);
      for (const uint64_t extent : field.shape) put(out, extent);
      offset += field.data.size();
    }
    for (const Field& field : fields_) out.insert(out.end(), field.data.begin(), field.data.end());
    return out;
  }

  template <typename T>
  static void put(std::vector<uint8_t>& out, T value) {
    const size_t at = out.size();
    out.resize(at + sizeof value);
    std::memcpy(&out[at], &value, sizeof value);
  }

 private:
  struct Field {
    std::string name;
    uint8_t type;
    std::vector<uint64_t> shape;
    std::vector<uint8_t> data;
  };
  std::vector<Field> fields_;
};

/// A small RGL file: uniform visible normals (so that the warp is the identity), D = 2, sigma = 0.5, and the color
/// `color(view theta index, y, x)`; `phi` holds the measured azimuths.
TensorFileBuilder small_rgl(const std::vector<float>& phi,
                            const std::function<Rgb(size_t, size_t, size_t, size_t)>& color);

/// A small Cornell file: `rows` random samples of `glossy`-like gray spectra.
std::string small_cornell(int rows, const std::function<float(const Vec3&, const Vec3&)>& f);

}  // namespace velour::test
