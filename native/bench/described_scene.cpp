#include "described_scene.h"

#include <filesystem>
#include <stdexcept>

#include "model/model_file.h"
#include "model/model_material.h"
#include "scene/obj_file.h"

namespace velour {
namespace {

std::shared_ptr<const Material> material_of(const Arguments& a) {
  const std::string& file = a["material"];
  if (is_model_file(file)) return make_material(std::make_shared<const Model>(load_model(file)), 0);
  return make_measured_material(load_measurement(file), std::make_shared<const Model>(load_model(a["proposal"])), 0);
}

}  // namespace

Arguments::Arguments(int argc, char** argv, std::map<std::string, std::string> values)
    : program_(std::filesystem::path(argv[0]).filename()), values_(std::move(values)) {
  for (int i = 1; i + 1 < argc; i += 2) values_[std::string(argv[i]).substr(2)] = argv[i + 1];
}

const std::string& Arguments::operator[](const std::string& name) const {
  const auto found = values_.find(name);
  if (found == values_.end()) throw std::runtime_error(program_ + ": --" + name + " is missing.");
  return found->second;
}

int Arguments::width() const { return std::stoi((*this)["size"]); }

int Arguments::height() const {
  const std::string& size = (*this)["size"];
  return std::stoi(size.substr(size.find('x') + 1));
}

void describe(const Arguments& a, Scene& scene) {
  const Affine up{{1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0}};
  const uint32_t mesh = scene.add_mesh(read_obj(a["mesh"]));
  scene.add_instance(mesh, up, {scene.add_material({.material = material_of(a)})});
  scene.set_environment(Environment::load(a["world"], {}, 1, Mat3(1)));
  scene.frame_camera(static_cast<float>(a.width()) / static_cast<float>(a.height()), 2);
  scene.commit();
}

}  // namespace velour
