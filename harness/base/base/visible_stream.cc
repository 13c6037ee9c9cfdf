// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/visible_stream.h"

#include "harness/base/base/text_file.h"

namespace prehend {

VisibleBuffer::VisibleBuffer(std::ostream& stream, std::size_t most_bytes)
    : stream_(stream), below_(stream.rdbuf(this)), most_bytes_(most_bytes) {}

VisibleBuffer::~VisibleBuffer() {
  if (!begun_.empty()) below_->sputn("\uFFFD", 3);
  const std::string more = BeyondText();
  PassOn(more);
  stream_.rdbuf(below_);
}

bool VisibleBuffer::Write(std::string_view bytes) {
  std::string text = std::move(begun_);
  text += bytes;
  begun_ = text.substr(text.size() - BegunUtf8(text));
  text.resize(text.size() - begun_.size());
  const std::string visible = most_bytes_ > 0 ? Cut(VisibleText(text)) : VisibleText(text);
  const auto size = static_cast<std::streamsize>(visible.size());
  return below_->sputn(visible.data(), size) == size;
}

std::string VisibleBuffer::BeyondText() const {
  return beyond_ == 0 ? "" : "... (" + std::to_string(beyond_) + " bytes more)";
}

std::string VisibleBuffer::Cut(std::string_view text) {
  std::string cut;
  for (const char c : text) {
    const bool is_within =
        (c & 0xc0) == 0x80 ? beyond_ == 0 : column_ < most_bytes_ && beyond_ == 0;
    if (c == '\n') {
      cut += BeyondText() + c;
      column_ = beyond_ = 0;
    } else {
      ++(is_within ? column_ : beyond_);
      if (is_within) cut += c;
    }
  }
  return cut;
}

void VisibleBuffer::PassOn(std::string_view code) {
  column_ = beyond_ = 0;
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
