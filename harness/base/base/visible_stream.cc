// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/visible_stream.h"

#include "harness/base/base/text_file.h"

namespace prehend {

VisibleBuffer::VisibleBuffer(std::ostream& stream) : stream_(stream), below_(stream.rdbuf(this)) {}

VisibleBuffer::~VisibleBuffer() {
  if (!begun_.empty()) below_->sputn("\uFFFD", 3);
  stream_.rdbuf(below_);
}

bool VisibleBuffer::Write(std::string_view bytes) {
  std::string text = std::move(begun_);
  text += bytes;
  begun_ = text.substr(text.size() - BegunUtf8(text));
  text.resize(text.size() - begun_.size());
  const std::string visible = VisibleText(text);
  const auto size = static_cast<std::streamsize>(visible.size());
  return below_->sputn(visible.data(), size) == size;
}

void VisibleBuffer::PassOn(std::string_view code) {
  below_->sputn(code.data(), static_cast<std::streamsize>(code.size()));
}

VisibleBuffer::int_type VisibleBuffer::overflow(int_type byte) {
  if (traits_type::eq_int_type(byte, traits_type::eof())) return traits_type::not_eof(byte);
  const char one = traits_type::to_char_type(byte);
  return Write({&one, 1}) ? byte : traits_type::eof();
}

std::streamsize VisibleBuffer::xsputn(const char* bytes, std::streamsize count) {
  return Write({bytes, static_cast<std::size_t>(count)}) ? count : 0;
}

int VisibleBuffer::sync() { return below_->pubsync(); }

std::ostream& operator<<(std::ostream& stream, const TerminalCode& code) {
  if (auto* const visible = dynamic_cast<VisibleBuffer*>(stream.rdbuf()))
    visible->PassOn(code.code);
  else
    stream << code.code;
  return stream;
}

}  // namespace prehend
