// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/video/container.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <optional>
#include <string_view>
#include <vector>

namespace vantage::internal {
namespace {

namespace fs = std::filesystem;
constexpr int kMaxChunks = 1 << 20;  // bounds the walk through a hostile file

/// Random access to the bytes of a file; reads beyond the end give nothing.
class Bytes {
 public:
  Bytes(const fs::path& path, std::uint64_t size) : stream_(path, std::ios::binary), size_(size) {}
  std::uint64_t size() const { return size_; }

  std::optional<std::string> Text(std::uint64_t offset, std::size_t length) {
    if (offset > size_ || length > size_ - offset) return std::nullopt;
    std::string text(length, '\0');
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(offset));
    if (!stream_.read(text.data(), static_cast<std::streamsize>(length))) return std::nullopt;
    return text;
  }
  /// Unsigned number of up to 8 bytes.
  std::optional<std::uint64_t> Big(std::uint64_t offset, std::size_t length) {
    const auto text = Text(offset, length);
    if (!text) return std::nullopt;
    std::uint64_t value = 0;
    for (const char c : *text) value = value << 8 | static_cast<unsigned char>(c);
    return value;
  }
  std::optional<std::uint64_t> Little(std::uint64_t offset, std::size_t length) {
    auto text = Text(offset, length);
    if (!text) return std::nullopt;
    std::uint64_t value = 0;
    for (auto c = text->rbegin(); c != text->rend(); ++c) {
      value = value << 8 | static_cast<unsigned char>(*c);
    }
    return value;
  }

 private:
  std::ifstream stream_;
  std::uint64_t size_;
};

/// One named stretch of a file: [begin, end) is its payload.
struct Chunk {
  std::string name;
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

// --- AVI -----------------------------------------------------------------------------------------

/// Children of a RIFF list; the last may promise more than the file holds.
std::vector<Chunk> RiffChunks(Bytes& bytes, std::uint64_t begin, std::uint64_t end) {
  std::vector<Chunk> chunks;
  for (std::uint64_t at = begin; at + 8 <= end && chunks.size() < kMaxChunks;) {
    const auto name = bytes.Text(at, 4);
    const auto size = bytes.Little(at + 4, 4);
    if (!name || !size) break;
    chunks.push_back({*name, at + 8, at + 8 + *size});
    at += 8 + *size + (*size & 1);
  }
  return chunks;
}

/// Number of the first video stream, in the two digits that its chunks' names begin with.
std::optional<std::string> AviVideoStream(Bytes& bytes, const Chunk& header) {
  int stream = 0;
  for (const Chunk& list : RiffChunks(bytes, header.begin + 4, header.end)) {
    if (list.name != "LIST" || bytes.Text(list.begin, 4) != "strl") continue;
    for (const Chunk& chunk : RiffChunks(bytes, list.begin + 4, list.end)) {
      if (chunk.name == "strh" && bytes.Text(chunk.begin, 4) == "vids") {
        return fmt::format("{:02}", stream);
      }
    }
    ++stream;
  }
  return std::nullopt;
}

/// Entries of the index that hold data: dropped frames have chunks of no bytes.
std::int64_t AviIndexedFrames(Bytes& bytes, const Chunk& index, std::string_view stream) {
  const auto entries = bytes.Text(index.begin, index.end - index.begin);
  if (!entries) return 0;
  std::int64_t frames = 0;
  for (std::size_t at = 0; at + 16 <= entries->size(); at += 16) {
    const std::string_view entry(entries->data() + at, 16);
    const bool picture = entry.substr(2, 2) == "dc" || entry.substr(2, 2) == "db";
    if (entry.substr(0, 2) == stream && picture &&
        entry.substr(12) != std::string_view("\0\0\0\0", 4)) {
      ++frames;
    }
  }
  return frames;
}

void InspectAvi(Bytes& bytes, ContainerFacts& facts) {
  // Files beyond 1 GB are several RIFF lists, of which idx1 indexes only the first. What follows
  // the last is padding; a size of 0 was never filled in by the writer.
  std::vector<Chunk> riffs = RiffChunks(bytes, 0, bytes.size());
  const auto padding = std::find_if(riffs.begin(), riffs.end(), [](const Chunk& chunk) {
    return chunk.name != "RIFF" || chunk.begin == chunk.end;
  });
  riffs.erase(padding, riffs.end());
  if (riffs.empty()) return;
  facts.needed_bytes = riffs.back().end;
  if (facts.cut_short() || riffs.size() != 1) return;
  std::optional<std::string> stream;
  for (const Chunk& chunk : RiffChunks(bytes, riffs[0].begin + 4, riffs[0].end)) {
    facts.needed_bytes = std::max(facts.needed_bytes, chunk.end);
    if (chunk.name == "LIST" && bytes.Text(chunk.begin, 4) == "hdrl") {
      stream = AviVideoStream(bytes, chunk);
    }
    if (chunk.name == "idx1" && stream) {
      facts.indexed_frames = AviIndexedFrames(bytes, chunk, *stream);
      facts.frame_count_exact = facts.indexed_frames > 0;
    }
  }
}

// --- MP4 and MOV (ISO/IEC 14496-12) --------------------------------------------------------------

std::vector<Chunk> Boxes(Bytes& bytes, std::uint64_t begin, std::uint64_t end) {
  std::vector<Chunk> boxes;
  for (std::uint64_t at = begin; at + 8 <= end && boxes.size() < kMaxChunks;) {
    auto size = bytes.Big(at, 4);
    const auto name = bytes.Text(at + 4, 4);
    const auto printable = [](unsigned char c) { return std::isprint(c) != 0; };
    if (!size || !name || !std::all_of(name->begin(), name->end(), printable)) break;
    std::uint64_t header = 8;
    if (*size == 1) {
      size = bytes.Big(at + 8, 8);
      header = 16;
      if (!size) break;
    } else if (*size == 0) {
      size = end - at;  // to the end of the file
    }
    if (*size < header || *size > UINT64_MAX / 2) break;
    boxes.push_back({*name, at + header, at + *size});
    at += *size;
  }
  return boxes;
}

std::optional<Chunk> Box(Bytes& bytes, const Chunk& parent, std::string_view name) {
  for (const Chunk& box : Boxes(bytes, parent.begin, parent.end)) {
    if (box.name == name) return box;
  }
  return std::nullopt;
}

/// Duration in seconds by the movie's or a track's header box (mvhd and mdhd begin alike).
struct TimeScale {
  double units_per_second = 0;
  double seconds = 0;
};
std::optional<TimeScale> ReadTimeScale(Bytes& bytes, const std::optional<Chunk>& header) {
  if (!header) return std::nullopt;
  const auto version = bytes.Big(header->begin, 1);
  const std::uint64_t wide = version == 1 ? 1 : 0;
  const auto scale = bytes.Big(header->begin + (wide ? 20 : 12), 4);
  const auto duration = bytes.Big(header->begin + (wide ? 24 : 16), wide ? 8 : 4);
  if (!scale || !duration || *scale == 0) return std::nullopt;
  const auto units = static_cast<double>(*scale);
  return TimeScale{units, static_cast<double>(*duration) / units};
}

/// True when the edit list of the video track shows all of the track.
bool ShowsWholeTrack(Bytes& bytes, const Chunk& movie, const Chunk& track, const Chunk& media) {
  const auto edits = Box(bytes, track, "edts");
  if (!edits) return true;
  const auto list = Box(bytes, *edits, "elst");
  if (!list) return true;
  const auto movie_time = ReadTimeScale(bytes, Box(bytes, movie, "mvhd"));
  const auto media_time = ReadTimeScale(bytes, Box(bytes, media, "mdhd"));
  const auto count = bytes.Big(list->begin + 4, 4);
  const bool wide = bytes.Big(list->begin, 1) == 1;
  if (!movie_time || !media_time || !count || *count > 1000) return false;
  double shown_secs = 0;
  for (std::uint64_t i = 0; i < *count; ++i) {
    const std::uint64_t entry = list->begin + 8 + i * (wide ? 20 : 12);
    const auto duration = bytes.Big(entry, wide ? 8 : 4);
    const auto start = bytes.Big(entry + (wide ? 8 : 4), wide ? 8 : 4);
    if (!duration || !start) return false;
    const bool empty_edit = *start == (wide ? UINT64_MAX : UINT32_MAX);
    if (!empty_edit) shown_secs += static_cast<double>(*duration) / movie_time->units_per_second;
  }
  const double rounding_secs = 2 / movie_time->units_per_second;
  return shown_secs + rounding_secs >= media_time->seconds;
}

void InspectMp4(Bytes& bytes, ContainerFacts& facts) {
  bool fragmented = false;
  std::optional<Chunk> movie;
  for (const Chunk& box : Boxes(bytes, 0, bytes.size())) {
    facts.needed_bytes = std::max(facts.needed_bytes, box.end);
    if (box.name == "moof") fragmented = true;
    if (box.name == "moov") movie = box;
  }
  if (!movie || fragmented) return;
  for (const Chunk& track : Boxes(bytes, movie->begin, movie->end)) {
    if (track.name != "trak") continue;
    const auto media = Box(bytes, track, "mdia");
    if (!media) continue;
    const auto handler = Box(bytes, *media, "hdlr");
    if (!handler || bytes.Text(handler->begin + 8, 4) != "vide") continue;
    facts.frame_count_exact = ShowsWholeTrack(bytes, *movie, track, *media);
    return;
  }
}

// --- Matroska and WebM (RFC 8794) ----------------------------------------------------------------

/// Length of an EBML number by its first byte; 0 when that is not valid.
std::size_t EbmlLength(std::uint64_t first) {
  for (std::size_t length = 1; length <= 8; ++length) {
    if (first & (0x100u >> length)) return length;
  }
  return 0;
}

void InspectMatroska(Bytes& bytes, ContainerFacts& facts) {
  constexpr std::uint64_t kSegment = 0x18538067;
  std::uint64_t at = 0;
  for (int element = 0; element < 16; ++element) {
    const auto first = bytes.Big(at, 1);
    const std::size_t id_length = first ? EbmlLength(*first) : 0;
    if (id_length == 0) return;
    const auto id = bytes.Big(at, id_length);
    const auto size_first = bytes.Big(at + id_length, 1);
    const std::size_t size_length = size_first ? EbmlLength(*size_first) : 0;
    if (!id || size_length == 0) return;
    const auto raw = bytes.Big(at + id_length, size_length);
    if (!raw) return;
    const std::uint64_t mask = (std::uint64_t{1} << (7 * size_length)) - 1;
    const std::uint64_t size = *raw & mask;
    at += id_length + size_length;
    if (*id == kSegment) {
      if (size != mask) facts.needed_bytes = at + size;  // all ones: a stream of unknown length
      return;
    }
    at += size;
  }
}

bool LooksLikeText(std::string_view head) {
  return !head.starts_with("YUV4MPEG2") &&
         std::all_of(head.begin(), head.end(), [](unsigned char c) {
           return std::isprint(c) != 0 || std::isspace(c) != 0 || c == 0x1b;
         });
}

}  // namespace

Result<ContainerFacts> InspectContainer(const fs::path& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) return Fail("{}: no such file", path.string());
  if (!fs::is_regular_file(status))
    return Fail("{}: is not a file; a video file is needed", path.string());
  ContainerFacts facts;
  facts.file_bytes = fs::file_size(path, code);
  if (code) return Fail("{}: cannot be read: {}", path.string(), code.message());
  if (facts.file_bytes == 0) return Fail("{}: is empty; a video file is needed", path.string());
  Bytes bytes(path, facts.file_bytes);
  const auto head = bytes.Text(0, std::min<std::size_t>(512, facts.file_bytes));
  if (!head) return Fail("{}: cannot be read", path.string());
  const std::string_view text(*head);
  if (LooksLikeText(text)) {
    return Fail("{}: is a text file; a video file is needed", path.string());
  }
  if (text.starts_with("RIFF") &&
      text.substr(std::min<std::size_t>(8, text.size())).starts_with("AVI ")) {
    InspectAvi(bytes, facts);
  } else if (text.size() > 8 && (text.substr(4, 4) == "ftyp" || text.substr(4, 4) == "moov" ||
                                 text.substr(4, 4) == "mdat" || text.substr(4, 4) == "wide")) {
    InspectMp4(bytes, facts);
  } else if (text.starts_with("\x1a\x45\xdf\xa3")) {
    InspectMatroska(bytes, facts);
  }
  return facts;
}

}  // namespace vantage::internal
