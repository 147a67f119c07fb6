#include "support/chi_square.h"
namespace velour::test { double sidak_level(double level, int tests) { return 1.0 - std::pow(1.0 - level, 1.0 / tests); } }
