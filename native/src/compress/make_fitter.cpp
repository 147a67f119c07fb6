#include "compress/make_fitter.h"

#include "compress/srbf_fit.h"
#include "compress/svd_fit.h"
#include "compress/view_svd_fit.h"

namespace velour {

std::unique_ptr<BtfFitter> make_fitter(const BtfMeasurement& measurement, const CompressOptions& options,
                                       FitCheckpoint& checkpoint, Progress& progress) {
  if (options.method == CompressMethod::svd) {
    return std::make_unique<SvdFitter>(measurement, options, checkpoint, progress);
  }
  if (options.method == CompressMethod::svd_view) {
    return std::make_unique<ViewSvdFitter>(measurement, options, checkpoint, progress);
  }
  return std::make_unique<SrbfFitter>(measurement, options, checkpoint, progress);
}

}  // namespace velour
