// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/components.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <opencv2/core.hpp>

namespace vantage {
namespace {

/// Foreground in one row, columns [begin, end). `parent` is an earlier run of the same component,
/// or the run itself.
struct Run {
  int row, begin, end;
  int parent;
};

int RootOf(std::vector<Run>& runs, int run) {
  while (runs[static_cast<std::size_t>(run)].parent != run) {
    Run& here = runs[static_cast<std::size_t>(run)];
    here.parent = runs[static_cast<std::size_t>(here.parent)].parent;
    run = here.parent;
  }
  return run;
}

/// The earlier root becomes the root of both.
void Join(std::vector<Run>& runs, int a, int b) {
  a = RootOf(runs, a);
  b = RootOf(runs, b);
  runs[static_cast<std::size_t>(std::max(a, b))].parent = std::min(a, b);
}

template <std::size_t kBytes>
bool AllZero(const std::uint8_t* pixels) {
  std::array<std::uint64_t, kBytes / 8> words;
  std::memcpy(words.data(), pixels, kBytes);
  std::uint64_t all = 0;
  for (const std::uint64_t word : words) all |= word;
  return all == 0;
}

void AppendRuns(const std::uint8_t* pixels, int columns, int row, std::vector<Run>& runs) {
  int x = 0;
  while (x < columns) {
    // Most of a mask is background: many pixels at a time.
    if (columns - x >= 64 && AllZero<64>(pixels + x)) {
      x += 64;
      continue;
    }
    if (columns - x >= 8 && AllZero<8>(pixels + x)) {
      x += 8;
      continue;
    }
    if (pixels[x] == 0) {
      ++x;
      continue;
    }
    const int begin = x;
    while (x < columns && pixels[x] != 0) ++x;
    runs.push_back({row, begin, x, static_cast<int>(runs.size())});
  }
}

/// All runs of the mask, each linked to the root of its component.
std::vector<Run> LabelledRuns(const cv::Mat& mask, int reach_px) {
  std::vector<Run> runs;
  std::vector<int> first(static_cast<std::size_t>(mask.rows) + 1, 0);  // run of each row
  for (int y = 0; y < mask.rows; ++y) {
    AppendRuns(mask.ptr(y), mask.cols, y, runs);
    const int begin = first[static_cast<std::size_t>(y)];
    const int end = static_cast<int>(runs.size());
    first[static_cast<std::size_t>(y) + 1] = end;
    for (int i = begin + 1; i < end; ++i) {
      const Run& left = runs[static_cast<std::size_t>(i) - 1];
      if (runs[static_cast<std::size_t>(i)].begin - left.end < reach_px) Join(runs, i - 1, i);
    }
    for (int above = std::max(0, y - reach_px); above < y; ++above) {
      int i = first[static_cast<std::size_t>(above)];
      const int above_end = first[static_cast<std::size_t>(above) + 1];
      for (int k = begin; k < end; ++k) {
        const Run run = runs[static_cast<std::size_t>(k)];
        while (i < above_end && runs[static_cast<std::size_t>(i)].end + reach_px <= run.begin) ++i;
        for (int n = i;
             n < above_end && runs[static_cast<std::size_t>(n)].begin < run.end + reach_px; ++n) {
          Join(runs, n, k);
        }
      }
    }
  }
  return runs;
}

/// The pixels of `c` that touch, among the 8 around them, one outside it.
cv::Mat TrueBorder(const cv::Mat& c) { return c & Grown(~c, 1); }

}  // namespace

std::vector<Component> FindComponents(const cv::Mat& mask, const ComponentRule& rule) {
  std::vector<Run> runs = LabelledRuns(mask, rule.reach_px);
  struct Extent {
    int area_px = 0;
    int left = 0, top = 0, right = 0, bottom = 0;  // exclusive on the right and below
    int component = -1;
  };
  std::vector<Extent> extents(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Run run = runs[i];
    Extent& all = extents[static_cast<std::size_t>(RootOf(runs, static_cast<int>(i)))];
    if (all.area_px == 0) all = {.left = run.begin, .top = run.row, .right = run.end};
    all.area_px += run.end - run.begin;
    all.left = std::min(all.left, run.begin);
    all.right = std::max(all.right, run.end);
    all.bottom = run.row + 1;
  }
  const cv::Rect picture({}, mask.size());
  const int margin_px = rule.margin_px;
  std::vector<Component> components;
  for (Extent& all : extents) {
    if (all.area_px == 0 || all.area_px < rule.min_area_px) continue;
    all.component = static_cast<int>(components.size());
    const cv::Rect box(all.left, all.top, all.right - all.left, all.bottom - all.top);
    const cv::Rect window = cv::Rect(box.x - margin_px, box.y - margin_px,
                                     box.width + 2 * margin_px, box.height + 2 * margin_px) &
                            picture;
    components.push_back({.box = box,
                          .area_px = all.area_px,
                          .window = window,
                          .pixels = cv::Mat::zeros(window.size(), CV_8UC1)});
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Run& run = runs[i];
    const int index =
        extents[static_cast<std::size_t>(RootOf(runs, static_cast<int>(i)))].component;
    if (index < 0) continue;
    Component& component = components[static_cast<std::size_t>(index)];
    std::memset(component.pixels.ptr(run.row - component.window.y, run.begin - component.window.x),
                255, static_cast<std::size_t>(run.end - run.begin));
  }
  return components;
}

cv::Mat Grown(const cv::Mat& pixels, int radius_px) {
  const int rows = pixels.rows;
  const int columns = pixels.cols;
  cv::Mat wide(rows, columns, CV_8UC1);
  for (int y = 0; y < rows; ++y) {
    const std::uint8_t* in = pixels.ptr(y);
    std::uint8_t* out = wide.ptr(y);
    std::memcpy(out, in, static_cast<std::size_t>(columns));
    for (int shift = 1; shift <= std::min(radius_px, columns - 1); ++shift) {
      for (int x = 0; x < columns - shift; ++x) out[x] |= in[x + shift];
      for (int x = shift; x < columns; ++x) out[x] |= in[x - shift];
    }
  }
  cv::Mat grown = cv::Mat::zeros(rows, columns, CV_8UC1);
  for (int y = 0; y < rows; ++y) {
    std::uint8_t* out = grown.ptr(y);
    for (int n = std::max(0, y - radius_px); n <= std::min(rows - 1, y + radius_px); ++n) {
      const std::uint8_t* in = wide.ptr(n);
      for (int x = 0; x < columns; ++x) out[x] |= in[x];
    }
  }
  return grown;
}

BorderRegions BorderOf(const Component& component, int half_width_px, int ring_px,
                       const cv::Mat& others) {
  const cv::Mat& c = component.pixels;
  BorderRegions regions;
  regions.true_border = TrueBorder(c);
  regions.expanded = Grown(regions.true_border, half_width_px);
  const cv::Mat covered = c | regions.expanded;
  regions.outer = Grown(covered, ring_px) & ~covered;
  const cv::Mat ring = Grown(regions.true_border, ring_px);
  regions.inside = ring & c & ~regions.true_border;
  regions.outside = ring & ~c;
  const int border_px = cv::countNonZero(regions.expanded);
  if (!others.empty() && cv::countNonZero(others) > 0) {
    const cv::Mat clear = ~Grown(others, half_width_px + 1);
    for (cv::Mat* region : {&regions.true_border, &regions.expanded, &regions.outer,
                            &regions.inside, &regions.outside}) {
      *region &= clear;
    }
  }
  regions.expansion = regions.expanded & ~regions.true_border;
  if (border_px > 0) {
    regions.free_share = static_cast<double>(cv::countNonZero(regions.expanded)) / border_px;
  }
  return regions;
}

}  // namespace vantage
