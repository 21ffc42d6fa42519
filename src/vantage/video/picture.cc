// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/video/picture.h"

#include <algorithm>
#include <array>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "vantage/base/file.h"

namespace vantage::internal {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kMaxFileBytes = std::size_t{1} << 29;

unsigned Byte(std::string_view bytes, std::size_t at) {
  return at < bytes.size() ? static_cast<unsigned char>(bytes[at]) : 0;
}
std::int64_t Big(std::string_view bytes, std::size_t at, std::size_t length) {
  std::int64_t value = 0;
  for (std::size_t i = 0; i < length; ++i) value = value << 8 | Byte(bytes, at + i);
  return value;
}
bool IsSpace(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
std::int64_t Little32(std::string_view bytes, std::size_t at) {
  const std::uint32_t value = Byte(bytes, at) | Byte(bytes, at + 1) << 8 |
                              Byte(bytes, at + 2) << 16 | Byte(bytes, at + 3) << 24;
  return static_cast<std::int32_t>(value);
}

/// What a header declares, and whether the file goes on to its end. Asked for here because OpenCV
/// fills what a truncated JPEG lacks with grey and reports success, and because the decoders print.
struct Header {
  std::int64_t width = 0;
  std::int64_t height = 0;
  bool complete = false;
};

Header PngHeader(std::string_view bytes) {
  Header header;
  if (bytes.substr(12, 4) == "IHDR") {
    header.width = Big(bytes, 16, 4);
    header.height = Big(bytes, 20, 4);
  }
  // Chunks of length, name, data, checksum, up to IEND.
  for (std::size_t at = 8; at + 12 <= bytes.size() && !header.complete;) {
    header.complete = bytes.substr(at + 4, 4) == "IEND";
    at += 12 + static_cast<std::size_t>(Big(bytes, at, 4));
  }
  return header;
}

Header JpegHeader(std::string_view bytes) {
  Header header;
  for (std::size_t at = 2; at + 4 <= bytes.size() && Byte(bytes, at) == 0xff;) {
    const unsigned marker = Byte(bytes, at + 1);
    if (marker == 0xff) {  // padding
      ++at;
      continue;
    }
    const auto length = static_cast<std::size_t>(Big(bytes, at + 2, 2));
    const bool frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame) {
      header.width = Big(bytes, at + 7, 2);
      header.height = Big(bytes, at + 5, 2);
    }
    if (marker == 0xda) {  // scan: 0xff within its data is always followed by 0
      header.complete = bytes.find("\xff\xd9", at + 2 + length) != std::string_view::npos;
      return header;
    }
    at += 2 + length;
  }
  return header;
}

Header BmpHeader(std::string_view bytes) {
  const auto file_bytes = static_cast<std::uint32_t>(Little32(bytes, 2));
  return {.width = Little32(bytes, 18),
          .height = std::abs(Little32(bytes, 22)),
          .complete = bytes.size() >= file_bytes};
}

/// PGM and PPM (P2, P3 text; P5, P6 binary): width, height, largest value, then the pixels.
Header PnmHeader(std::string_view bytes) {
  std::array<std::int64_t, 3> numbers = {};
  std::size_t at = 2;
  for (std::int64_t& number : numbers) {
    while (at < bytes.size() && (IsSpace(bytes[at]) || bytes[at] == '#')) {
      at = bytes[at] == '#' ? std::min(bytes.find('\n', at), bytes.size()) : at + 1;
    }
    const std::size_t start = at;
    while (at < bytes.size() && bytes[at] >= '0' && bytes[at] <= '9' && at - start < 9) {
      number = number * 10 + (bytes[at++] - '0');
    }
  }
  const auto [width, height, largest] = numbers;
  const bool binary = bytes[1] >= '5';
  const std::int64_t channels = bytes[1] == '3' || bytes[1] == '6' ? 3 : 1;
  const std::int64_t pixel_bytes = binary ? channels * (largest > 255 ? 2 : 1) : 2 * channels;
  const std::int64_t needed = static_cast<std::int64_t>(at) + width * height * pixel_bytes;
  return {.width = width,
          .height = height,
          .complete = largest > 0 && static_cast<std::int64_t>(bytes.size()) >= needed};
}

Result<ImageSize> CheckHeader(const std::string& name, std::string_view bytes) {
  if (bytes.empty()) return Fail("{}: is empty; a picture is needed", name);
  Header header;
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) {
    header = PngHeader(bytes);
  } else if (bytes.starts_with("\xff\xd8")) {
    header = JpegHeader(bytes);
  } else if (bytes.starts_with("BM")) {
    header = BmpHeader(bytes);
  } else if (bytes.starts_with("P2") || bytes.starts_with("P3") || bytes.starts_with("P5") ||
             bytes.starts_with("P6")) {
    header = PnmHeader(bytes);
  } else {
    return Fail("{}: is not a picture that can be read; PNG, JPEG, BMP, PGM and PPM can", name);
  }
  if (header.width != 0 || header.height != 0) {
    VANTAGE_RETURN_IF_ERROR(CheckPictureSize(name, header.width, header.height));
  }
  if (!header.complete || header.width == 0) {
    return Fail("{}: the picture is damaged or cut short", name);
  }
  return ImageSize{static_cast<int>(header.width), static_cast<int>(header.height)};
}

}  // namespace

Status CheckPictureSize(std::string_view name, std::int64_t width, std::int64_t height) {
  constexpr std::int64_t kMaxSide = 32768;
  constexpr std::int64_t kMaxArea = 100'000'000;
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide ||
      width * height > kMaxArea) {
    return Fail(
        "{}: declares pictures of {} x {} px; each side must be 1 to {} and the area at most {} "
        "million",
        name, width, height, kMaxSide, kMaxArea / 1'000'000);
  }
  return {};
}

Result<ImageSize> PictureSize(const fs::path& path) {
  VANTAGE_ASSIGN_OR_RETURN(const std::string bytes, ReadTextFile(path, kMaxFileBytes));
  return CheckHeader(path.string(), bytes);
}

Result<cv::Mat> ReadPicture(const fs::path& path) {
  VANTAGE_ASSIGN_OR_RETURN(std::string bytes, ReadTextFile(path, kMaxFileBytes));
  VANTAGE_ASSIGN_OR_RETURN(const ImageSize size, CheckHeader(path.string(), bytes));
  try {
    const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8UC1, bytes.data());
    cv::Mat picture = cv::imdecode(encoded, cv::IMREAD_UNCHANGED);
    if (picture.empty()) return Fail("{}: the picture is damaged or cut short", path.string());
    if (picture.cols != size.width || picture.rows != size.height) {
      return Fail("{}: the picture is damaged: it decodes to {} x {} px and declares {} x {}",
                  path.string(), picture.cols, picture.rows, size.width, size.height);
    }
    if (picture.depth() == CV_16U) picture.convertTo(picture, CV_8U, 255.0 / 65535.0);
    if (picture.depth() != CV_8U) {
      return Fail("{}: the picture has values that are not of 8 or 16 bits", path.string());
    }
    cv::Mat color = picture;
    if (picture.channels() == 1) cv::cvtColor(picture, color, cv::COLOR_GRAY2BGR);
    if (picture.channels() == 4) cv::cvtColor(picture, color, cv::COLOR_BGRA2BGR);
    if (color.channels() != 3) {
      return Fail("{}: the picture has {} channels; 1, 3 or 4 can be read", path.string(),
                  color.channels());
    }
    return color;
  } catch (const cv::Exception& error) {
    return Fail("{}: the picture is damaged: {}", path.string(), error.err);
  }
}

double LargestChannelDifference(const cv::Mat& picture) {
  std::array<cv::Mat, 3> channels;
  cv::split(picture, channels.data());
  const auto& [blue, green, red] = channels;
  return std::max({cv::norm(blue, green, cv::NORM_INF), cv::norm(green, red, cv::NORM_INF),
                   cv::norm(red, blue, cv::NORM_INF)});
}

bool HasPictureExtension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array<std::string_view, 6> kKnown = {".png", ".jpg", ".jpeg",
                                                      ".bmp", ".pgm", ".ppm"};
  return std::find(kKnown.begin(), kKnown.end(), extension) != kKnown.end();
}

}  // namespace vantage::internal
