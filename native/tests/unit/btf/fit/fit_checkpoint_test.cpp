#include "btf/fit/fit_checkpoint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "base/file.h"
#include "btf/fit/btf_fit.h"
#include "support/striped_btf.h"
#include "support/warnings.h"
#include "unit/btf/fit/factored_fits.h"

namespace velour::fit_checkpoint_test {
namespace {

class Checkpoint : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove(path_); }
  void TearDown() override { std::filesystem::remove(path_); }

  FitCheckpoint made(bool resume, const std::string& key = "a key") const {
    return FitCheckpoint({path_, key, resume});
  }
  /// Writes a matrix and two numbers.
  void keep_some() const {
    FitCheckpoint checkpoint = made(false);
    checkpoint.keep("matrix", matrix_);
    checkpoint.keep_numbers("numbers", std::vector<double>{0.1, -1e-300});
    checkpoint.keep_integers("integers", {3, 0, 7});
    checkpoint.write();
  }
  const std::string path_ =
      testing::TempDir() + "velour-checkpoint-" + testing::UnitTest::GetInstance()->current_test_info()->name();
  const RowMatrix matrix_ = RowMatrix::Random(5, 4);
};

TEST_F(Checkpoint, GivesBackTheBitsThatItWasGiven) {
  keep_some();
  const FitCheckpoint checkpoint = made(true);
  EXPECT_EQ(checkpoint.matrix("matrix", 5, 4), matrix_);
  EXPECT_EQ(checkpoint.numbers("numbers", 2), (std::vector<double>{0.1, -1e-300}));
  EXPECT_EQ(checkpoint.integers("integers", 3, 7), (std::vector<size_t>{3, 0, 7}));
  EXPECT_TRUE(checkpoint.warnings().empty());
}

TEST_F(Checkpoint, GivesNothingThatIsNotAsAskedFor) {
  keep_some();
  const FitCheckpoint checkpoint = made(true);
  EXPECT_FALSE(checkpoint.matrix("matrix", 4, 5));
  EXPECT_FALSE(checkpoint.matrix("another", 5, 4));
  EXPECT_FALSE(checkpoint.numbers("numbers", 1));
  EXPECT_FALSE(checkpoint.numbers("matrix", 100));
  EXPECT_FALSE(checkpoint.integers("integers", 3, 6));
  EXPECT_FALSE(checkpoint.integers("numbers", 3, 6));
}

TEST_F(Checkpoint, OfAnotherFitIsIgnoredWithASentence) {
  keep_some();
  const FitCheckpoint other = made(true, "another key");
  EXPECT_FALSE(other.matrix("matrix", 5, 4));
  ASSERT_EQ(other.warnings().size(), 1u);
  EXPECT_EQ(other.warnings()[0].code, WarningCode::fit_not_resumed);
  const auto reason = test::value_of<std::string>(other.warnings()[0], "reason");
  EXPECT_NE(reason.find("belongs to a fit of another BTF"), std::string::npos) << reason;
  EXPECT_FALSE(made(false).matrix("matrix", 5, 4));  // not asked for
}

TEST_F(Checkpoint, ThatIsDamagedIsIgnoredWithASentence) {
  keep_some();
  std::vector<uint8_t> bytes = read_file(path_);
  bytes.resize(bytes.size() / 2);
  write_file(path_, bytes);
  EXPECT_EQ(made(true).warnings().size(), 1u);
  write_file(path_, std::vector<uint8_t>(1000, 0x5a));
  EXPECT_EQ(made(true).warnings().size(), 1u);
}

/// Wherever a byte is damaged, no stage has other values than those that were kept.
TEST_F(Checkpoint, GivesNoDamagedStage) {
  keep_some();
  const std::vector<uint8_t> bytes = read_file(path_);
  for (size_t i = 0; i < bytes.size(); ++i) {
    std::vector<uint8_t> damaged = bytes;
    damaged[i] ^= 1;
    write_file(path_, damaged);
    const FitCheckpoint checkpoint = made(true);
    EXPECT_FALSE(checkpoint.matrix("matrix", 5, 4)) << i;
    EXPECT_FALSE(checkpoint.numbers("numbers", 2)) << i;
    EXPECT_EQ(checkpoint.warnings().size(), 1u) << i;
  }
}

/// A fit may be killed at any time, also twice.
TEST_F(Checkpoint, HasTheCompleteBlocksOfAFileThatEndsEarly) {
  keep_some();
  const size_t block = read_file(path_).size();
  {
    FitCheckpoint checkpoint = made(true);
    checkpoint.forget("num");
    checkpoint.keep("another", matrix_);
    checkpoint.write();
  }
  const std::vector<uint8_t> bytes = read_file(path_);
  for (size_t size = block; size < bytes.size(); ++size) {
    write_file(path_, std::span(bytes).first(size));
    FitCheckpoint checkpoint = made(true);
    ASSERT_EQ(checkpoint.matrix("matrix", 5, 4), matrix_) << size;
    ASSERT_TRUE(checkpoint.numbers("numbers", 2)) << size;
    ASSERT_FALSE(checkpoint.matrix("another", 5, 4)) << size;
    checkpoint.keep("third", matrix_);
    checkpoint.write();
    ASSERT_EQ(made(true).matrix("third", 5, 4), matrix_) << size;
  }
  write_file(path_, bytes);
  EXPECT_EQ(made(true).matrix("another", 5, 4), matrix_);
  EXPECT_FALSE(made(true).numbers("numbers", 2));
}

TEST_F(Checkpoint, WhereNothingCanBeWrittenSaysSoOnce) {
  FitCheckpoint checkpoint({testing::TempDir() + "no/such/folder", "a key", true});
  checkpoint.keep("matrix", matrix_);
  checkpoint.write();
  checkpoint.write();
  EXPECT_EQ(checkpoint.warnings().size(), 1u);
}

/// Cancels at a fraction of the progress, always at the same place: reads are counted.
class CountingBtf final : public BtfMeasurement {
 public:
  CountingBtf(const BtfMeasurement& of, const std::string& sha256, Progress& progress, uint64_t stop_at)
      : of_(of), progress_(progress), stop_at_(stop_at) {
    layout_ = of.layout();
    grid_ = of.grid();
    provenance_.sha256 = sha256;
  }
  void read_pairs(uint64_t first, uint64_t count, std::span<HalfBits> values) const override {
    if (count > 1 && ++reads_ == stop_at_) progress_.cancel();
    of_.read_pairs(first, count, values);
  }
  uint64_t reads() const { return reads_; }

 private:
  const BtfMeasurement& of_;
  Progress& progress_;
  uint64_t stop_at_;
  mutable uint64_t reads_ = 0;
};

struct Outcome {
  std::optional<Model> model;
  uint64_t reads;
};

Outcome compress(const BtfMeasurement& btf, const CompressOptions& options, uint64_t stop_at,
                 const std::string& sha256 = "0123") {
  Progress progress;
  const CountingBtf counting(btf, sha256, progress, stop_at);
  try {
    return {compress_btf(counting, options, progress), counting.reads()};
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::cancelled);
    return {std::nullopt, counting.reads()};
  }
}

bool same_bits(const TensorSide& a, const TensorSide& b) {
  if (a.clusters.size() != b.clusters.size() || a.levels.size() != b.levels.size()) return false;
  for (size_t c = 0; c < a.clusters.size(); ++c) {
    const TensorBtfCluster &one = a.clusters[c], &two = b.clusters[c];
    if (one.view != two.view || one.light != two.light || one.color != two.color || one.core != two.core) return false;
  }
  for (size_t l = 0; l < a.levels.size(); ++l) {
    if (a.levels[l].member != b.levels[l].member || a.levels[l].value != b.levels[l].value) return false;
  }
  return true;
}

bool same_bits(const ModelBody& a, const ModelBody& b) {
  if (const auto* one = std::get_if<TensorBtf>(&a)) {
    const auto& two = std::get<TensorBtf>(b);
    return std::equal(one->sides.begin(), one->sides.end(), two.sides.begin(), two.sides.end(),
                      [](const TensorSide& s, const TensorSide& t) { return same_bits(s, t); });
  }
  if (const auto* one = std::get_if<FactoredBtf>(&a)) {
    return one->pair_value == std::get<FactoredBtf>(b).pair_value &&
           one->levels[0].value == std::get<FactoredBtf>(b).levels[0].value;
  }
  const auto &one = std::get<SrbfBtf>(a), &two = std::get<SrbfBtf>(b);
  if (one.sides.size() != two.sides.size()) return false;
  for (size_t s = 0; s < one.sides.size(); ++s) {
    for (size_t l = 0; l < one.sides[s].levels.size(); ++l) {
      if (one.sides[s].levels[l].value != two.sides[s].levels[l].value) return false;
    }
  }
  return true;
}

/// That several fits are tried for.
CompressOptions options_of(CompressMethod method) {
  CompressOptions options;
  options.method = method;
  const bool tensors = method == CompressMethod::tucker || method == CompressMethod::kcta;
  options.bytes = method == CompressMethod::srbf ? 1200 : tensors ? 6000 : 40000;
  options.tolerance = method == CompressMethod::srbf ? 0.2 : tensors ? 0.12 : 0.08;
  // Its search for a size is Tucker's; the shapes of one size are several fits, too.
  if (method == CompressMethod::kcta) options.tolerance = 0;
  return options;
}

class Resumed : public testing::TestWithParam<CompressMethod> {};

/// Wherever a fit is stopped, it ends with the bits of one that was not, and reads less.
TEST_P(Resumed, HasTheBitsOfAFitThatWasNotStopped) {
  const std::string path = testing::TempDir() + "velour-resumed-" + std::to_string(static_cast<int>(GetParam()));
  const test::MemoryBtf btf = test::striped_btf({6, 4}, GetParam() == CompressMethod::srbf);
  CompressOptions options = options_of(GetParam());
  options.threads = 1;  // that threads change no bits is tested of every method
  const Outcome whole = compress(btf, options, 0);
  ASSERT_TRUE(whole.model);
  options.checkpoint = path;
  options.resume = true;
  const double first = GetParam() == CompressMethod::svd_view ? 0.45 : 0.3;  // of all reading, after the first stage
  for (const double share : {first, 0.6, 0.95}) {
    std::filesystem::remove(path);
    const auto stop_at = static_cast<uint64_t>(share * static_cast<double>(whole.reads));
    EXPECT_FALSE(compress(btf, options, stop_at).model) << share;
    EXPECT_TRUE(std::filesystem::exists(path));
    const Outcome rest = compress(btf, options, 0);
    ASSERT_TRUE(rest.model);
    EXPECT_TRUE(same_bits(rest.model->body, whole.model->body)) << share;
    EXPECT_EQ(rest.model->btf->relative_l2, whole.model->btf->relative_l2);
    EXPECT_EQ(rest.model->btf->search, whole.model->btf->search);
    EXPECT_EQ(rest.model->btf->order, whole.model->btf->order);
    EXPECT_LT(rest.reads, whole.reads);
    // The model is not saved yet: if that fails, the fit is not lost.
    const Outcome again = compress(btf, options, 0);
    ASSERT_TRUE(again.model);
    EXPECT_TRUE(same_bits(again.model->body, whole.model->body)) << share;
    EXPECT_LE(again.reads, rest.reads);
  }
}

/// With a tolerance, sketches of more and more components are computed; only the newest is stored.
TEST(ResumedFit, OfSingularValuesGoesOnWithItsLargestSketch) {
  const std::string path = testing::TempDir() + "velour-resumed-sketch";
  std::filesystem::remove(path);
  const auto noise = [](const DirectionPair& pair, uint32_t x, uint32_t y) {
    return test::noise({{pair.wl.x + 0.01f * pair.wl.y, 0, 0}, {0, pair.wv.y + 0.01f * pair.wv.x, 0}}, x, y);
  };
  const test::MemoryBtf btf({ring_directions(30, 9), ring_directions(50, 12)}, {12, 10}, noise);
  CompressOptions options;
  options.method = CompressMethod::svd;
  options.tolerance = 0.01;
  options.threads = 1;
  const Outcome whole = compress(btf, options, 0);
  ASSERT_TRUE(whole.model);
  options.checkpoint = path;
  options.resume = true;
  // The colors take a pass over the views, each sketch three: stopped in the first pass of the third sketch.
  const uint64_t views = btf.layout().views().size(), stop_at = 8 * views - 1;
  EXPECT_FALSE(compress(btf, options, stop_at).model);
  const Outcome rest = compress(btf, options, 0);
  ASSERT_TRUE(rest.model);
  EXPECT_TRUE(same_bits(rest.model->body, whole.model->body));
  EXPECT_LE(rest.reads + stop_at, whole.reads + 2 * views);  // passes that had no stage yet
  std::filesystem::remove(path);
}

TEST(ResumedFit, OfAnotherBtfOfTheSameSizeBeginsAnew) {
  const std::string path = testing::TempDir() + "velour-resumed-another";
  std::filesystem::remove(path);
  const test::MemoryBtf btf = test::striped_btf({6, 4}, false);
  CompressOptions options = options_of(CompressMethod::svd);
  options.checkpoint = path;
  options.resume = true;
  const uint64_t reads = compress(btf, options, 0).reads;
  std::filesystem::remove(path);
  EXPECT_FALSE(compress(btf, options, reads / 2).model);
  EXPECT_TRUE(std::filesystem::exists(path));
  EXPECT_EQ(compress(btf, options, 0, "4567").reads, reads);
}

INSTANTIATE_TEST_SUITE_P(Methods, Resumed,
                         testing::Values(CompressMethod::svd, CompressMethod::srbf, CompressMethod::svd_view,
                                         CompressMethod::tucker, CompressMethod::kcta));

}  // namespace
}  // namespace velour::fit_checkpoint_test
