// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/method.h"

#include <utility>

#include "vantage/background/opencv_method.h"

namespace vantage {
namespace {

class MixtureMethod final : public BackgroundMethod {
 public:
  explicit MixtureMethod(MixtureModel model) : model_(std::move(model)) {}
  Status Apply(const cv::Mat& bgr, const cv::Mat& held, cv::Mat& mask, int threads) override {
    return model_.Apply(bgr, mask, threads, held);
  }
  Status Absorb(const cv::Mat& pixels) override { return model_.Absorb(pixels); }
  cv::Mat BackgroundImage(const cv::Rect& region) const override {
    return model_.BackgroundImage(region);
  }
  Result<bool> Relight(const cv::Mat& gain, int threads) override {
    VANTAGE_RETURN_IF_ERROR(model_.Relight(gain, threads));
    return true;
  }
  void Restart() override { model_.Restart(); }

 private:
  MixtureModel model_;
};

}  // namespace

cv::Mat BackgroundMethod::BackgroundImage(const cv::Rect& /*region*/) const { return {}; }
Result<bool> BackgroundMethod::Relight(const cv::Mat& /*gain*/, int /*threads*/) { return false; }
void BackgroundMethod::Restart() {}

Result<std::unique_ptr<BackgroundMethod>> CreateMethod(MethodKind kind, ImageSize size,
                                                       const MixtureOptions& options) {
  if (kind == MethodKind::kMixture) {
    VANTAGE_ASSIGN_OR_RETURN(MixtureModel model, MixtureModel::Create(size, options));
    return std::make_unique<MixtureMethod>(std::move(model));
  }
  return CreateOpenCvMethod(kind, size);
}

}  // namespace vantage
