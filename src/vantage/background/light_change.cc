// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/light_change.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace vantage {
namespace {

constexpr int kBlock = 8;  // samples on a block's side
// Levels that may have been clipped say nothing about gain and offset.
constexpr int kDarkest = 5;
constexpr int kBrightest = 250;
// Fewer samples that differ from the background than this share, by this share of its level, are
// no change of the light.
constexpr double kLeastDiffering = 0.25;
constexpr double kDiffer = 0.05;
constexpr int kNear_levels = 20;        // "near" a prediction, in each channel
constexpr double kChanged = 0.08;       // of a block's level
constexpr double kLocal = 0.15;         // what a block may differ from the smooth surface
constexpr double kTextured_levels = 6;  // standard deviation inside a block
constexpr int kBins = 16;
constexpr int kSurfaceTerms = 6;
constexpr int kRounds = 4;

double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Line {
  double gain = 1;
  double offset = 0;
};

/// Levels of the frame by the level of the background behind them.
using SeenByLevel = std::array<std::vector<double>, 256>;

/// I = gain B + offset by the medians of bins of B, joined by the median slope (Theil and Sen).
Line FitLine(const SeenByLevel& seen_by_level) {
  std::size_t total = 0;
  for (const auto& seen : seen_by_level) total += seen.size();
  std::vector<std::pair<double, double>> medians;
  std::vector<double> bin;
  double level_sum = 0;
  for (std::size_t level = 0; level < seen_by_level.size(); ++level) {
    const auto& seen = seen_by_level[level];
    bin.insert(bin.end(), seen.begin(), seen.end());
    level_sum += static_cast<double>(level * seen.size());
    if (bin.size() * kBins < total || bin.empty()) continue;
    medians.emplace_back(level_sum / static_cast<double>(bin.size()), Median(bin));
    bin.clear();
    level_sum = 0;
  }
  std::vector<double> slopes;
  for (std::size_t i = 0; i < medians.size(); ++i) {
    for (std::size_t k = i + 1; k < medians.size(); ++k) {
      const double apart = medians[k].first - medians[i].first;
      // Nearer bins are of one level but for the noise.
      if (apart >= 8) slopes.push_back((medians[k].second - medians[i].second) / apart);
    }
  }
  std::vector<double> rest;
  if (slopes.empty()) {
    for (const auto& [behind, seen] : medians) rest.push_back(seen / behind);
    return {.gain = Median(rest), .offset = 0};
  }
  const double gain = std::clamp(Median(slopes), 1.0 / 32, 32.0);
  for (const auto& [behind, seen] : medians) rest.push_back(seen - gain * behind);
  return {.gain = gain, .offset = Median(rest)};
}

using Terms = cv::Vec<double, kSurfaceTerms>;
Terms TermsAt(const cv::Mat& blocks, int column, int row) {
  const double x = blocks.cols > 1 ? 2.0 * column / (blocks.cols - 1) - 1 : 0;
  const double y = blocks.rows > 1 ? 2.0 * row / (blocks.rows - 1) - 1 : 0;
  return {1, x, y, x * x, x * y, y * y};
}

/// A surface of second order through the logarithms of the blocks' factors (0: block without one),
/// by weights that fall with the distance from it (Cauchy's), so that people are outvoted.
Terms FitSurface(const cv::Mat& factors) {
  std::vector<double> logs;
  for (int row = 0; row < factors.rows; ++row) {
    for (int column = 0; column < factors.cols; ++column) {
      const double factor = factors.at<double>(row, column);
      if (factor > 0) logs.push_back(std::log(factor));
    }
  }
  Terms surface = Terms::all(0);
  if (logs.empty()) return surface;
  surface[0] = Median(logs);
  for (int iteration = 0; iteration < 10; ++iteration) {
    cv::Matx<double, kSurfaceTerms, kSurfaceTerms> normal =
        1e-3 * cv::Matx<double, kSurfaceTerms, kSurfaceTerms>::eye();
    Terms right = 1e-3 * surface;
    for (int row = 0; row < factors.rows; ++row) {
      for (int column = 0; column < factors.cols; ++column) {
        const double factor = factors.at<double>(row, column);
        if (factor <= 0) continue;
        const Terms terms = TermsAt(factors, column, row);
        const double value = std::log(factor);
        const double off = (value - surface.dot(terms)) / 0.1;
        const double weight = 1 / (1 + off * off);
        normal += weight * terms * terms.t();
        right += weight * value * terms;
      }
    }
    const cv::Matx<double, kSurfaceTerms, 1> solved = normal.solve(right, cv::DECOMP_CHOLESKY);
    for (int i = 0; i < kSurfaceTerms; ++i) surface[i] = solved(i);
  }
  return surface;
}

struct Samples {
  const cv::Mat& frame;
  const cv::Mat& background;
  const cv::Mat& foreground;
  const cv::Mat& ignored;

  bool Ignored(int x, int y) const {
    return !ignored.empty() && ignored.at<std::uint8_t>(y, x) != 0;
  }
  int Seen(int x, int y, int c) const { return frame.at<cv::Vec3b>(y, x)[c]; }
  int Behind(int x, int y, int c) const { return background.at<cv::Vec3b>(y, x)[c]; }
  bool Usable(int x, int y, int c) const {
    const int seen = Seen(x, y, c);
    const int behind = Behind(x, y, c);
    return !Ignored(x, y) && std::min(seen, behind) > kDarkest &&
           std::max(seen, behind) < kBrightest;
  }
};

/// Calls `visit(column, row, samples of the block)` for each block.
template <class Visit>
void ForEachBlock(cv::Size samples, const Visit& visit) {
  for (int y = 0; y < samples.height; y += kBlock) {
    for (int x = 0; x < samples.width; x += kBlock) {
      visit(x / kBlock, y / kBlock, cv::Rect(x, y, kBlock, kBlock) & cv::Rect({}, samples));
    }
  }
}

/// Medians of I / (a B + b) over the usable samples of each block, 0 where they are too few.
cv::Mat BlockFactors(const Samples& samples, cv::Size blocks, int channel, const Line& line) {
  cv::Mat factors = cv::Mat::zeros(blocks, CV_64FC1);
  std::vector<double> ratios;
  ForEachBlock(samples.frame.size(), [&](int column, int row, const cv::Rect& block) {
    ratios.clear();
    for (int y = block.y; y < block.br().y; ++y) {
      for (int x = block.x; x < block.br().x; ++x) {
        if (!samples.Usable(x, y, channel)) continue;
        const double lit = line.gain * samples.Behind(x, y, channel) + line.offset;
        ratios.push_back(samples.Seen(x, y, channel) / std::max(lit, 1.0));
      }
    }
    if (4 * static_cast<int>(ratios.size()) >= block.area()) {
      factors.at<double>(row, column) = Median(ratios);
    }
  });
  return factors;
}

/// The field s: the surface, and a block's own factor where that is near the surface; others are
/// people, or things of their own light.
cv::Mat SmoothField(const cv::Mat& factors) {
  const Terms surface = FitSurface(factors);
  cv::Mat field(factors.size(), CV_32FC1);
  for (int row = 0; row < factors.rows; ++row) {
    for (int column = 0; column < factors.cols; ++column) {
      const double factor = factors.at<double>(row, column);
      const double smooth = surface.dot(TermsAt(factors, column, row));
      const bool own = factor > 0 && std::abs(std::log(factor) - smooth) <= kLocal;
      field.at<float>(row, column) = static_cast<float>(own ? factor : std::exp(smooth));
    }
  }
  cv::medianBlur(field, field, 3);
  return field;
}

/// Luma, blurred so that a camera that trembles still sees the same texture.
cv::Mat Texture(const cv::Mat& samples) {
  cv::Mat luma;
  cv::cvtColor(samples, luma, cv::COLOR_BGR2GRAY);
  cv::blur(luma, luma, {3, 3});
  return luma;
}

/// Whether enough samples differ from the background for a change of the light: the cheap question
/// before the others.
bool MayHaveChanged(const Samples& samples) {
  int used = 0;
  int differ = 0;
  for (int y = 0; y < samples.frame.rows; ++y) {
    for (int x = 0; x < samples.frame.cols; ++x) {
      if (samples.Ignored(x, y)) continue;
      bool differs = false;
      for (int c = 0; c < 3; ++c) {
        const int behind = samples.Behind(x, y, c);
        differs = differs || std::abs(samples.Seen(x, y, c) - behind) > kDiffer * behind;
      }
      ++used;
      differ += differs ? 1 : 0;
    }
  }
  return differ > kLeastDiffering * used;
}

/// Median correlation of frame and background over the textured blocks.
double StructureOf(const Samples& samples) {
  const cv::Mat frame = Texture(samples.frame);
  const cv::Mat background = Texture(samples.background);
  std::vector<double> correlations;
  ForEachBlock(frame.size(), [&](int, int, const cv::Rect& block) {
    cv::Scalar seen, seen_sigma, behind, behind_sigma;
    cv::meanStdDev(frame(block), seen, seen_sigma);
    cv::meanStdDev(background(block), behind, behind_sigma);
    if (behind_sigma[0] < kTextured_levels) return;
    const double covariance =
        frame(block).dot(background(block)) / block.area() - seen[0] * behind[0];
    correlations.push_back(covariance / (std::max(seen_sigma[0], 1.0) * behind_sigma[0]));
  });
  return correlations.empty() ? 1 : Median(correlations);
}

/// Fills the figures that tell whether the light explains the frame.
void Judge(const Samples& samples, LightChange& change) {
  int used = 0;
  int explained = 0;
  int lit = 0;
  int blocks = 0;
  int changed = 0;
  std::vector<double> factors;
  ForEachBlock(samples.frame.size(), [&](int column, int row, const cv::Rect& block) {
    const cv::Vec3f field = change.field.at<cv::Vec3f>(row, column);
    int block_used = 0;
    cv::Vec3d before(1, 1, 1);  // sums of levels; 1 keeps quotient and logarithm defined
    cv::Vec3d after(1, 1, 1);
    for (int y = block.y; y < block.br().y; ++y) {
      for (int x = block.x; x < block.br().x; ++x) {
        if (samples.Ignored(x, y)) continue;
        bool near_before = true;
        bool near_after = true;
        for (int c = 0; c < 3; ++c) {
          const double seen = samples.Seen(x, y, c);
          const double behind = samples.Behind(x, y, c);
          const double predicted = change.Predict(field[c], c, behind);
          near_before = near_before && std::abs(seen - behind) <= kNear_levels;
          near_after = near_after && std::abs(seen - predicted) <= kNear_levels;
          before[c] += behind;
          after[c] += predicted;
        }
        ++block_used;
        if (near_after) ++explained;
        if (near_after && !near_before && samples.foreground.at<std::uint8_t>(y, x) != 0) ++lit;
      }
    }
    used += block_used;
    if (4 * block_used < block.area()) return;
    ++blocks;
    factors.push_back((after[0] + after[1] + after[2]) / (before[0] + before[1] + before[2]));
    bool block_changed = false;
    for (int c = 0; c < 3; ++c) {
      block_changed = block_changed || std::abs(std::log(after[c] / before[c])) > kChanged;
    }
    if (block_changed) ++changed;
  });
  if (blocks == 0) return;
  change.explained = static_cast<double>(explained) / used;
  change.lit = static_cast<double>(lit) / used;
  change.changed = static_cast<double>(changed) / blocks;
  change.factor = Median(factors);
  change.structure = StructureOf(samples);
}

}  // namespace

double LightChange::Predict(double light, int channel, double level) const {
  const auto c = static_cast<std::size_t>(channel);
  return std::clamp(light * (gain[c] * level + offset[c]), 0.0, 255.0);
}

cv::Mat SamplePixels(const cv::Mat& picture, int step_px) {
  const int first = step_px / 2;
  const cv::Size size((picture.cols - first + step_px - 1) / step_px,
                      (picture.rows - first + step_px - 1) / step_px);
  cv::Mat samples(size, picture.type());
  const std::size_t bytes = picture.elemSize();
  for (int row = 0; row < size.height; ++row) {
    std::uint8_t* to = samples.ptr(row);
    for (int column = 0; column < size.width; ++column) {
      const std::uint8_t* from = picture.ptr(first + row * step_px, first + column * step_px);
      for (std::size_t k = 0; k < bytes; ++k) *to++ = from[k];
    }
  }
  return samples;
}

LightChange EstimateLightChange(const cv::Mat& frame, const cv::Mat& background,
                                const cv::Mat& foreground, const cv::Mat& ignored) {
  const Samples samples{frame, background, foreground, ignored};
  const cv::Size blocks((frame.cols + kBlock - 1) / kBlock, (frame.rows + kBlock - 1) / kBlock);
  LightChange change;
  change.field = cv::Mat(blocks, CV_32FC3, cv::Scalar::all(1));
  if (!MayHaveChanged(samples)) return change;
  std::vector<cv::Mat> fields;
  for (int c = 0; c < 3; ++c) {
    cv::Mat field(blocks, CV_32FC1, cv::Scalar(1));
    Line line;
    // Gain and offset need the field, the field needs them: each round sees both better.
    for (int round = 0; round < kRounds; ++round) {
      SeenByLevel seen;
      std::size_t count = 0;
      for (int y = 0; y < frame.rows; ++y) {
        for (int x = 0; x < frame.cols; ++x) {
          if (!samples.Usable(x, y, c)) continue;
          const double light = field.at<float>(y / kBlock, x / kBlock);
          const auto level = static_cast<std::size_t>(samples.Behind(x, y, c));
          seen[level].push_back(samples.Seen(x, y, c) / light);
          ++count;
        }
      }
      if (10 * count < frame.total() || count == 0) return change;
      line = FitLine(seen);
      field = SmoothField(BlockFactors(samples, blocks, c, line));
    }
    change.gain[static_cast<std::size_t>(c)] = line.gain;
    change.offset[static_cast<std::size_t>(c)] = line.offset;
    fields.push_back(field);
  }
  cv::merge(fields, change.field);
  Judge(samples, change);
  return change;
}

cv::Mat GainPicture(const LightChange& change, const cv::Mat& background) {
  cv::Mat gain;
  cv::resize(change.field, gain, background.size(), 0, 0, cv::INTER_LINEAR);
  for (int y = 0; y < gain.rows; ++y) {
    auto* to = gain.ptr<cv::Vec3f>(y);
    const auto* behind = background.ptr<cv::Vec3b>(y);
    for (int x = 0; x < gain.cols; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double level = std::max<double>(behind[x][c], 1);
        const double factor = change.Predict(to[x][c], c, level) / level;
        to[x][c] = static_cast<float>(std::clamp(factor, 1.0 / 32, 32.0));
      }
    }
  }
  return gain;
}

}  // namespace vantage
