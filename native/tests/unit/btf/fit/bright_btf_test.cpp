#include <gtest/gtest.h>

#include "btf/fit/btf_fit.h"
#include "model/file/model_file.h"
#include "support/striped_btf.h"

namespace velour::bright_btf_test {
namespace {

class BrightBtf : public testing::TestWithParam<CompressMethod> {};

/// Coefficients exceed half floats, although no value of the BTF does.
TEST_P(BrightBtf, IsFittedAndRead) {
  const test::MemoryBtf btf(test::ringed_layout(), {6, 4}, [](const DirectionPair& d, uint32_t x, uint32_t y) {
    return 98304.0f * test::striped(d, x, y);
  });
  CompressOptions options;
  options.method = GetParam();
  options.companding = Companding::none;
  Progress progress;
  const Model bright = compress_btf(btf, options, progress);
  EXPECT_LT(bright.btf->relative_l2, 0.5);
  const Model back = decode_model(encode_model(bright), "bright.velour");
  EXPECT_EQ(encode_model(back), encode_model(bright));
}

INSTANTIATE_TEST_SUITE_P(Methods, BrightBtf,
                         testing::Values(CompressMethod::svd, CompressMethod::svd_view, CompressMethod::srbf,
                                         CompressMethod::kcta));

}  // namespace
}  // namespace velour::bright_btf_test
