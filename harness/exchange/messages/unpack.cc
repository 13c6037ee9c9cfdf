// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/messages/unpack.h
#include "harness/exchange/messages/unpack.h"

#include <lz4frame.h>
#include <zstd.h>

#include <memory>

namespace prehend::exchange {

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

}  // namespace prehend::exchange
