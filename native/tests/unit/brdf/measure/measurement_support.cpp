#include "measurement_support.h"

#include <cmath>
#include <cstdio>

namespace velour::test {

TensorFileBuilder small_rgl(const std::vector<float>& phi,
                            const std::function<Rgb(size_t, size_t, size_t, size_t)>& color) {
  const std::vector<float> theta{0.0f, 0.5f, 1.0f, 1.5707f};
  const size_t views = phi.size() * theta.size();
  std::vector<float> rgb;
  for (size_t p = 0; p < phi.size(); ++p)
    for (size_t t = 0; t < theta.size(); ++t)
      for (int c = 0; c < 3; ++c)
        for (size_t y = 0; y < 4; ++y)
          for (size_t x = 0; x < 5; ++x) rgb.push_back(color(p, t, y, x)[c]);
  const std::string words = "synthetic";
  TensorFileBuilder builder;
  builder.add("description", 1, {words.size()}, std::vector<uint8_t>(words.begin(), words.end()))
      .floats("phi_i", {phi.size()}, phi)
      .floats("theta_i", {theta.size()}, theta)
      .floats("ndf", {2, 3}, std::vector<float>(6, 2.0f))
      .floats("sigma", {2, 2}, std::vector<float>(4, 0.5f))
      .floats("vndf", {phi.size(), theta.size(), 3, 3}, std::vector<float>(views * 9, 7.0f))
      .floats("rgb", {phi.size(), theta.size(), 3, 4, 5}, rgb)
      .add("jacobian", 1, {1}, std::vector<uint8_t>{1});
  return builder;
}

std::string small_cornell(int rows, const std::function<float(const Vec3&, const Vec3&)>& f) {
  std::string text = "# A test\n# of words\n3\n400 550 700\n";
  char line[200];
  RandomStream random(3, 0, 0);
  const auto theta = [&] { return std::acos(std::max(random.next(), 0.05f)); };
  for (int i = 0; i < rows; ++i) {
    const float t_l = theta(), p_l = 6.2f * random.next(), t_v = theta(), p_v = 6.2f * random.next();
    const auto value = static_cast<double>(f(direction(t_l, p_l), direction(t_v, p_v)));
    std::snprintf(line, sizeof line, "%.6f %.6f %.6f %.6f %.7g %.7g %.7g\n", static_cast<double>(t_l),
                  static_cast<double>(p_l), static_cast<double>(t_v), static_cast<double>(p_v), value, value, value);
    text += line;
  }
  return text;
}

}  // namespace velour::test
