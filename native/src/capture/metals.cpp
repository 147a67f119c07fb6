#include "capture/metals.h"

#include "job/error.h"

namespace velour {
namespace {

struct Metal {
  const char* name;
  std::span<const double> wavelengths;  // nanometers, over the visible range
  std::span<const RefractiveIndex> indices;
};

// Gold, copper, silver: [JC72]; nickel, iron, chromium, titanium: [JC74], at the same photon energies. Evaporated films
// at room temperature, taken from the refractiveindex.info database [Pol24], which is in the public domain.
constexpr double kJohnsonChristy[] = {354.2, 367.9, 381.5, 397.4, 413.3, 430.5, 450.9, 471.4, 495.9,
                                      520.9, 548.6, 582.1, 616.8, 659.5, 704.5, 756.0, 821.1, 892.0};
constexpr RefractiveIndex kGold[] = {{1.5, 1.866},  {1.48, 1.895}, {1.46, 1.933}, {1.47, 1.952}, {1.46, 1.958},
                                     {1.45, 1.948}, {1.38, 1.914}, {1.31, 1.849}, {1.04, 1.833}, {0.62, 2.081},
                                     {0.43, 2.455}, {0.29, 2.863}, {0.21, 3.272}, {0.14, 3.697}, {0.13, 4.103},
                                     {0.14, 4.542}, {0.16, 5.083}, {0.17, 5.663}};
constexpr RefractiveIndex kCopper[] = {{1.37, 1.916}, {1.36, 1.975}, {1.33, 2.045}, {1.32, 2.116}, {1.28, 2.207},
                                       {1.25, 2.305}, {1.24, 2.397}, {1.25, 2.483}, {1.22, 2.564}, {1.18, 2.608},
                                       {1.02, 2.577}, {0.7, 2.704},  {0.3, 3.205},  {0.22, 3.747}, {0.21, 4.205},
                                       {0.24, 4.665}, {0.26, 5.18},  {0.3, 5.768}};
constexpr RefractiveIndex kSilver[] = {{0.1, 1.419},  {0.07, 1.657}, {0.05, 1.864}, {0.05, 2.07},  {0.05, 2.275},
                                       {0.04, 2.462}, {0.04, 2.657}, {0.05, 2.869}, {0.05, 3.093}, {0.05, 3.324},
                                       {0.06, 3.586}, {0.05, 3.858}, {0.06, 4.152}, {0.05, 4.483}, {0.04, 4.838},
                                       {0.03, 5.242}, {0.04, 5.727}, {0.04, 6.312}};
constexpr RefractiveIndex kNickel[] = {{1.74, 2.32}, {1.7, 2.4},   {1.72, 2.48}, {1.72, 2.57}, {1.7, 2.69},
                                       {1.71, 2.82}, {1.73, 2.95}, {1.78, 3.09}, {1.82, 3.25}, {1.85, 3.42},
                                       {1.92, 3.61}, {1.96, 3.8},  {1.99, 4.02}, {1.99, 4.26}, {2.06, 4.5},
                                       {2.13, 4.73}, {2.26, 4.97}, {2.4, 5.23}};
constexpr RefractiveIndex kIron[] = {{1.93, 2.35}, {2.02, 2.43}, {2.12, 2.5},  {2.24, 2.58}, {2.35, 2.65},
                                     {2.48, 2.71}, {2.59, 2.77}, {2.67, 2.82}, {2.74, 2.88}, {2.86, 2.91},
                                     {2.95, 2.93}, {2.94, 2.99}, {2.88, 3.05}, {2.92, 3.1},  {2.86, 3.19},
                                     {2.87, 3.28}, {2.94, 3.39}, {2.96, 3.56}};
constexpr RefractiveIndex kChromium[] = {{1.84, 2.64}, {1.87, 2.69}, {1.92, 2.74}, {2.0, 2.83},  {2.08, 2.93},
                                         {2.19, 3.04}, {2.33, 3.14}, {2.51, 3.24}, {2.75, 3.3},  {2.94, 3.33},
                                         {3.18, 3.33}, {3.22, 3.3},  {3.17, 3.3},  {3.09, 3.34}, {3.05, 3.39},
                                         {3.08, 3.42}, {3.2, 3.48},  {3.3, 3.52}};
constexpr RefractiveIndex kTitanium[] = {{1.82, 2.87}, {1.9, 2.9},   {1.99, 2.93}, {2.08, 2.95}, {2.14, 2.98},
                                         {2.21, 3.01}, {2.27, 3.04}, {2.32, 3.1},  {2.36, 3.19}, {2.44, 3.3},
                                         {2.54, 3.43}, {2.6, 3.58},  {2.67, 3.72}, {2.76, 3.84}, {2.86, 3.96},
                                         {3.0, 4.01},  {3.21, 4.01}, {3.29, 3.96}};

// [Rak95], at wavelengths of its own.
constexpr double kRakic[] = {326.28, 364.66, 413.28, 442.8,  476.87, 516.6,  563.57, 619.93,
                             652.25, 688.81, 729.32, 774.91, 794.78, 815.69, 837.74};
constexpr RefractiveIndex kAluminium[] = {{0.31474, 3.9165}, {0.39877, 4.3957}, {0.52135, 5.0008}, {0.6079, 5.3676},
                                          {0.7278, 5.7781},  {0.8734, 6.2418},  {1.0728, 6.7839},  {1.366, 7.4052},
                                          {1.5724, 7.7354},  {1.8301, 8.0601},  {2.1606, 8.3565},  {2.6154, 8.4914},
                                          {2.7675, 8.3866},  {2.7668, 8.2573},  {2.6945, 8.1878}};

constexpr Metal kMetals[] = {
    {"nickel", kJohnsonChristy, kNickel},     {"gold", kJohnsonChristy, kGold},
    {"copper", kJohnsonChristy, kCopper},     {"aluminium", kRakic, kAluminium},
    {"silver", kJohnsonChristy, kSilver},     {"iron", kJohnsonChristy, kIron},
    {"chromium", kJohnsonChristy, kChromium}, {"titanium", kJohnsonChristy, kTitanium},
};

const Metal& metal_named(const std::string& name) {
  for (const Metal& metal : kMetals) {
    if (name == metal.name) return metal;
  }
  std::string known;
  for (const std::string& n : metal_names()) known += (known.empty() ? "" : ", ") + n;
  throw Error(Status::invalid_argument, "Unknown metal \"" + name + "\"; use one of " + known + ".");
}

}  // namespace

std::vector<std::string> metal_names() {
  std::vector<std::string> names;
  for (const Metal& metal : kMetals) names.emplace_back(metal.name);
  return names;
}

Reflectance metal_reflectance(const std::string& name, double outside) {
  const Metal& metal = metal_named(name);
  std::vector<RefractiveIndex> relative;
  for (const RefractiveIndex& index : metal.indices) relative.push_back({index.n / outside, index.k / outside});
  return {metal.wavelengths, relative};
}

}  // namespace velour
