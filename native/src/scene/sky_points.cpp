#include "scene/sky_points.h"

#include <cmath>

#include "scene/equirectangular.h"

namespace velour {
namespace {

constexpr double kMostEnergy = 1.0 / 4096;
constexpr double kWidest = 3.0 * kPiD / 180;

/// A rectangle of texels.
struct Cell {
  int x0, y0, x1, y1;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
};

class Gathering {
 public:
  explicit Gathering(const EquirectangularImage& image)
      : image_(image), columns_(static_cast<size_t>(image.width()) + 1) {
    sum_energy();
    // Azimuth of a column's center: Blender's u = 1/2 - phi / (2 pi).
    for (int x = 0; x < image.width(); ++x) {
      const double phi = 2 * kPiD * (0.5 - (x + 0.5) / image.width());
      cosine_.push_back(std::cos(phi));
      sine_.push_back(std::sin(phi));
    }
  }

  SkyPoints run() {
    std::vector<Cell> open = {{0, 0, image_.width(), image_.height()}};
    while (!open.empty()) {
      const Cell cell = open.back();
      open.pop_back();
      if (!splits(cell)) {
        add(cell);
        continue;
      }
      const bool across = width(cell) >= height(cell) ? cell.width() > 1 : cell.height() <= 1;
      const int x = (cell.x0 + cell.x1) / 2, y = (cell.y0 + cell.y1) / 2;
      open.push_back(across ? Cell{x, cell.y0, cell.x1, cell.y1} : Cell{cell.x0, y, cell.x1, cell.y1});
      open.push_back(across ? Cell{cell.x0, cell.y0, x, cell.y1} : Cell{cell.x0, cell.y0, cell.x1, y});
    }
    return std::move(points_);
  }

 private:
  /// Summed-area table of luminance x solid angle.
  void sum_energy() {
    const int w = image_.width(), h = image_.height();
    sums_.assign(columns_ * (static_cast<size_t>(h) + 1), 0.0);
    for (int y = 0; y < h; ++y) {
      const EnvironmentTexel* row = image_.row(y) + 1;
      double along = 0;
      for (int x = 0; x < w; ++x) {
        along += solid_angle(y) * luminance_of(row[x]);
        sum_at(x + 1, y + 1) = sum_at(x + 1, y) + along;
      }
    }
    total_ = sum_at(w, h);
  }

  double& sum_at(int x, int y) { return sums_[static_cast<size_t>(y) * columns_ + static_cast<size_t>(x)]; }
  static double luminance_of(const EnvironmentTexel& t) { return static_cast<double>(luminance({t.r, t.g, t.b})); }
  double theta(double y) const { return kPiD * y / image_.height(); }
  double solid_angle(int y) const { return 2 * kPiD / image_.width() * (std::cos(theta(y)) - std::cos(theta(y + 1))); }
  double height(const Cell& c) const { return theta(c.height()); }
  double width(const Cell& c) const {
    return 2 * kPiD * c.width() / image_.width() * std::sin(theta(0.5 * (c.y0 + c.y1)));
  }

  bool splits(const Cell& c) {
    if (c.width() == 1 && c.height() == 1) return false;
    const double energy = sum_at(c.x1, c.y1) - sum_at(c.x0, c.y1) - sum_at(c.x1, c.y0) + sum_at(c.x0, c.y0);
    return energy > kMostEnergy * total_ || std::max(width(c), height(c)) > kWidest;
  }

  void add(const Cell& cell) {
    Vec3d moment(0), plain(0), color(0);
    double energy = 0, area = 0;
    for (int y = cell.y0; y < cell.y1; ++y) {
      const EnvironmentTexel* row = image_.row(y) + 1;
      const double share = solid_angle(y), t = theta(y + 0.5);
      const double z = std::cos(t), sine = std::sin(t);
      // A texel's mean direction is shorter by area / (4 pi); a bilinear footprint has twice the texel's variance.
      const double shortened = 1 - share / (2 * kPiD);
      for (int x = cell.x0; x < cell.x1; ++x) {
        const auto at = static_cast<size_t>(x);
        const Vec3d w = shortened * Vec3d(sine * cosine_[at], sine * sine_[at], z);
        const double e = share * luminance_of(row[x]);
        moment += e * w;
        plain += share * w;
        color += share * Vec3d(row[x].r, row[x].g, row[x].b);
        energy += e;
        area += share;
      }
    }
    push(energy > 0 ? moment / energy : plain / area, color / total_, energy / total_, area);
  }

  void push(const Vec3d& mean, const Vec3d& color, double energy, double area) {
    const double length = glm::length(mean);
    const Vec3 unit(mean / length);
    points_.x.push_back(unit.x);
    points_.y.push_back(unit.y);
    points_.z.push_back(unit.z);
    points_.spread.push_back(static_cast<float>(1 - length));
    points_.energy.push_back(static_cast<float>(energy));
    points_.solid_angle.push_back(static_cast<float>(area));
    points_.r.push_back(static_cast<float>(color.r));
    points_.g.push_back(static_cast<float>(color.g));
    points_.b.push_back(static_cast<float>(color.b));
  }

  const EquirectangularImage& image_;
  const size_t columns_;
  std::vector<double> sums_, cosine_, sine_;
  double total_ = 0;
  SkyPoints points_;
};

}  // namespace

SkyPoints sky_points(const EquirectangularImage& image) { return Gathering(image).run(); }

}  // namespace velour
