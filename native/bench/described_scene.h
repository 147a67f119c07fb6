// The scene of `velour render` with its defaults, for programs that look into it.
#pragma once

#include <map>
#include <string>

#include "scene/scene.h"

namespace velour {

/// Pairs of words: --name value.
class Arguments {
 public:
  /// `values`: those that need not be given.
  Arguments(int argc, char** argv, std::map<std::string, std::string> values);
  /// Throws where it was not given and has no default.
  const std::string& operator[](const std::string& name) const;
  int width() const;
  int height() const;

 private:
  std::string program_;
  std::map<std::string, std::string> values_;
};

/// --mesh, whose y is up; --material, a model, or a measurement with the model that draws as --proposal; --world; the
/// camera that frames the mesh in a picture of --size. Committed.
void describe(const Arguments& arguments, Scene& scene);

}  // namespace velour
