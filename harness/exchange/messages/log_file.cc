// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/messages/log_file.h"

#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

namespace prehend::exchange {
namespace {

/// Frames of LZ4, one after another. "" if they do not become `size` bytes.
std::string FromLz4(std::string_view packed, std::size_t size) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION))) return "";
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, &LZ4F_freeDecompressionContext);
  std::string out(size, '\0');
  std::size_t read = 0, written = 0;
  while (read < packed.size()) {
    std::size_t in_size = packed.size() - read, out_size = size - written;
    const std::size_t state = LZ4F_decompress(context.get(), out.data() + written, &out_size,
                                              packed.data() + read, &in_size, nullptr);
    read += in_size;
    written += out_size;
    if (LZ4F_isError(state) || (in_size == 0 && out_size == 0)) return "";
  }
  return written == size ? out : "";
}

std::string FromZstd(std::string_view packed, std::size_t size) {
  std::string out(size, '\0');
  return ZSTD_decompress(out.data(), size, packed.data(), packed.size()) == size ? out : "";
}

}  // namespace

LogFile::LogFile(std::istream& in, std::uint64_t size, const TakesMessage& take,
                 const HearsOfChannel& tell)
    : in_(in), size_(size), take_(take), tell_(tell) {
  if (size > kMaxLogBytes) problem_ = fmt::format("it is larger than {} GiB", kMaxLogBytes >> 30);
}

void LogFile::Fail(std::string_view why) {
  if (ok()) problem_ = fmt::format("{} {}: {}", place_, record_at_, why);
}

std::string LogFile::Take(std::uint64_t count) {
  std::string bytes(static_cast<std::size_t>(std::min(count, left())), '\0');
  in_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in_.gcount()));
  at_ += bytes.size();
  return bytes;
}

void LogFile::Skip(std::uint64_t count) {
  in_.seekg(static_cast<std::streamoff>(count), std::ios::cur);
  at_ += count;
}

bool LogFile::Admits(const char* what, std::uint64_t bytes) {
  if (bytes > kMaxLogRecordBytes)
    Fail(fmt::format("a {} of {} MiB; at most {} MiB are read", what, bytes >> 20,
                     kMaxLogRecordBytes >> 20));
  return ok();
}

bool LogFile::AdmitsChunk(std::uint64_t bytes) {
  if (!Admits("chunk", bytes)) return false;
  content_bytes_ += bytes;
  if (content_bytes_ > std::max(kMaxLogContentBytes, kMaxLogContentOfByte * size_))
    Fail(fmt::format("its chunks become more than {} MiB and more than {} times the file",
                     kMaxLogContentBytes >> 20, kMaxLogContentOfByte));
  return ok();
}

bool LogFile::AdmitsMore(const char* what, std::size_t count) {
  if (count >= kMaxLogChannels) Fail(fmt::format("more than {} {}s", kMaxLogChannels, what));
  return ok();
}

std::string LogFile::Unpack(std::string_view compression, std::string_view packed,
                            std::uint64_t size, std::string_view what_is_read) {
  if (!AdmitsChunk(size)) return "";
  const auto bytes = static_cast<std::size_t>(size);
  const bool is_plain = compression.empty() || compression == "none";
  if (!is_plain && compression != "lz4" && compression != "zstd") {
    Fail(fmt::format("a chunk with the compression '{}'; {}", compression.substr(0, 40),
                     what_is_read));
    return "";
  }
  std::string records = is_plain               ? std::string(packed)
                        : compression == "lz4" ? FromLz4(packed, bytes)
                                               : FromZstd(packed, bytes);
  if (records.size() != size) Fail("a damaged chunk: it cannot be decompressed");
  return records;
}

std::string_view LogFile::Keep(std::string_view definition) {
  const auto known = definitions_.find(definition);
  if (known != definitions_.end()) return *known;
  definition_bytes_ += definition.size();
  if (definition_bytes_ > kMostDefinitionBytes) {
    Fail(fmt::format("more than {} MiB of definitions of types", kMostDefinitionBytes >> 20));
    return {};
  }
  return *definitions_.emplace(definition).first;
}

void LogFile::TakeChannel(const char* kind, std::uint32_t id, const LogChannel& channel) {
  const auto known = channels_.find(id);
  if (known == channels_.end()) {
    if (AdmitsMore(kind, channels_.size())) tell_(channels_.emplace(id, channel).first->second);
    return;
  }
  if (known->second.topic != channel.topic)
    Fail(fmt::format("{} {} is '{}' and '{}'", kind, id, known->second.topic, channel.topic));
}

const LogChannel* LogFile::ChannelOf(const char* kind, std::uint32_t id) {
  const auto channel = channels_.find(id);
  if (channel != channels_.end()) return &channel->second;
  Fail(fmt::format("a message of {} {}, which is not there", kind, id));
  return nullptr;
}

void LogFile::TakeMessage(const LogMessage& message) {
  const std::string why = take_(message);
  if (!why.empty()) Fail(why);
}

}  // namespace prehend::exchange
