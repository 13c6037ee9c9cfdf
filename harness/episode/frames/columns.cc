// SPDX-License-Identifier: Apache-2.0
// See harness/episode/frames/columns.h. Tested by tests/harness/episode/frames/columns_test.cc
#include "harness/episode/frames/columns.h"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "harness/episode/frames/rigid_motion.h"

namespace prehend::episode {
namespace {

constexpr std::size_t kPosition = 0, kRotation = 3, kVelocity = 7, kSpin = 10, kMotionColumns = 13;

/// How a column is guessed; the number is in the file.
enum class Guess : std::uint8_t {
  kConstant = 0,  ///< all rows as the first
  kBefore = 1,    ///< as the row that it continues
  kLinear = 2,    ///< goes on as it went: the polynomial through the last two values
  kSquare = 3,    ///< through the last three
  kCube = 4,      ///< through the last four
  kMotion = 5,    ///< position and rotation: as the velocities move the body
  kBeside = 6     ///< as the row above it, which continues another one
};

double AsDouble(Word word) { return std::bit_cast<double>(word); }
Word AsWord(double value) { return std::bit_cast<Word>(value); }

/// Of each row the one that it continues, or -1.
class Order {
 public:
  Order(const Guesses& guesses, std::size_t rows) : before_(guesses.before), rows_(rows) {
    for (std::size_t row = 0; row < before_.size() && is_runs_; ++row)
      is_runs_ = before_[row] < 0 || before_[row] + 1 == static_cast<int>(row);
  }
  bool IsGiven() const { return !before_.empty(); }
  /// Whether each row continues the one above, or none.
  bool IsRuns() const { return is_runs_; }
  /// Calls `look(first, size)`.
  template <typename Look>
  void EachRun(const Look& look) const {
    for (std::size_t begin = 0; begin < rows_;) {
      std::size_t end = begin + 1;
      while (end < rows_ && Before(end) >= 0) ++end;
      look(begin, end - begin);
      begin = end;
    }
  }
  int Before(std::size_t row) const {
    return before_.empty() ? static_cast<int>(row) - 1 : before_[row];
  }
  /// Rows that continue none.
  std::size_t Starts() const {
    if (before_.empty()) return std::min<std::size_t>(rows_, 1);
    return static_cast<std::size_t>(std::ranges::count_if(before_, [](int b) { return b < 0; }));
  }

 private:
  const std::vector<int>& before_;
  std::size_t rows_;
  bool is_runs_ = true;
};

/// The next value of the polynomial through `known` values, the latest first.
inline double Polynomial(const double* x, std::size_t known) {
  switch (known) {
    case 1:
      return x[0];
    case 2:
      return x[0] + (x[0] - x[1]);
    case 3:
      return 3 * (x[0] - x[1]) + x[2];
    default:
      return 4 * (x[0] + x[2]) - 6 * x[1] - x[3];
  }
}

/// The next value of the polynomial through the last 2, 3 or 4 values; with less past, a simpler
/// one.
Word PolynomialGuess(std::span<const Word> column, const Order& order, int last,
                     std::size_t values) {
  double x[4] = {};
  std::size_t known = 0;
  const auto take = [&](int row) { x[known++] = AsDouble(column[static_cast<std::size_t>(row)]); };
  if (order.IsGiven()) {
    for (int row = last; row >= 0 && known < values;
         row = order.Before(static_cast<std::size_t>(row)))
      take(row);
  } else {
    for (int row = last; row >= 0 && known < values; --row) take(row);
  }
  const double guess = Polynomial(x, known);
  return std::isfinite(guess) ? AsWord(guess) : column[static_cast<std::size_t>(last)];
}

/// What a row is guessed to be from the row that it continues and those before; not by kMotion.
Word GuessAt(Guess guess, std::span<const Word> column, const Order& order, std::size_t row) {
  const int before = order.Before(row);
  switch (guess) {
    case Guess::kLinear:
      return PolynomialGuess(column, order, before, 2);
    case Guess::kSquare:
      return PolynomialGuess(column, order, before, 3);
    case Guess::kCube:
      return PolynomialGuess(column, order, before, 4);
    case Guess::kBeside:
      return column[row - 1];
    case Guess::kConstant:
    case Guess::kBefore:
    case Guess::kMotion:
      break;
  }
  return column[static_cast<std::size_t>(before)];
}

Vector3 Vector3At(const Columns& columns, std::size_t row, std::size_t first) {
  return {AsDouble(columns.At(row, first)), AsDouble(columns.At(row, first + 1)),
          AsDouble(columns.At(row, first + 2))};
}

/// Where the body is in `row` if it moved as its velocities say.
Word MovedGuess(const Columns& columns, std::size_t row, std::size_t axis, double dt_s) {
  const double guess = AsDouble(columns.At(row - 1, kPosition + axis)) +
                       AsDouble(columns.At(row, kVelocity + axis)) * dt_s;
  return std::isfinite(guess) ? AsWord(guess) : columns.At(row - 1, kPosition + axis);
}

std::array<Word, 4> TurnedGuess(const Columns& columns, std::size_t row, double dt_s) {
  const Turn before = {
      AsDouble(columns.At(row - 1, kRotation)), AsDouble(columns.At(row - 1, kRotation + 1)),
      AsDouble(columns.At(row - 1, kRotation + 2)), AsDouble(columns.At(row - 1, kRotation + 3))};
  const Turn turned = Turned(before, Vector3At(columns, row, kSpin), dt_s);
  const std::array<double, 4> values = {turned.x, turned.y, turned.z, turned.w};
  std::array<Word, 4> guess{};
  for (std::size_t i = 0; i < 4; ++i)
    guess[i] = std::isfinite(values[i]) ? AsWord(values[i]) : columns.At(row - 1, kRotation + i);
  return guess;
}

bool IsMotion(const Columns& columns, const Guesses& guesses) {
  return guesses.dt_s > 0 && columns.width >= kMotionColumns && guesses.before.empty();
}

class Encoder {
 public:
  Encoder(const Columns& columns, const Guesses& guesses)
      : columns_(columns), order_(guesses, columns.rows), dt_s_(guesses.dt_s) {
    if (!IsMotion(columns, guesses) || columns.rows < 2) return;
    is_motion_ = true;
    turned_.resize(columns.rows);
    for (std::size_t row = 1; row < columns.rows; ++row)
      turned_[row] = TurnedGuess(columns, row, dt_s_);
  }

  void Append(std::size_t column, std::string& bytes) {
    const std::span<const Word> words = columns_.Column(column);
    if (std::ranges::all_of(words, [&](Word word) { return word == words.front(); })) {
      bytes += static_cast<char>(Guess::kConstant);
      return AppendWord(words.front(), bytes);
    }
    const bool may_move = is_motion_ && column < kVelocity;
    Guess best = Guess::kBefore;
    Word best_bits = ~Word{0};
    for (const Guess guess : {Guess::kBefore, Guess::kLinear, Guess::kSquare, Guess::kCube,
                              Guess::kMotion, Guess::kBeside}) {
      if (guess == Guess::kMotion && !may_move) continue;
      if (guess == Guess::kBeside && !order_.IsGiven()) continue;
      const Word bits = SampledBits(guess, column);
      if (bits >= best_bits) continue;
      best = guess;
      best_bits = bits;
    }
    distances_.clear();
    if (best != Guess::kMotion && best != Guess::kBeside && order_.IsRuns()) {
      order_.EachRun([&](std::size_t begin, std::size_t size) {
        AddDistances(words.subspan(begin, size), best);
      });
    } else {
      for (std::size_t row = 0; row < words.size(); ++row) {
        if (order_.Before(row) >= 0)
          distances_.push_back(Distance(words[row], GuessOf(best, column, row)));
      }
    }
    AppendCoded(best, words, bytes);
  }

 private:
  Word GuessOf(Guess guess, std::size_t column, std::size_t row) const {
    if (guess != Guess::kMotion) return GuessAt(guess, columns_.Column(column), order_, row);
    return column < kRotation ? MovedGuess(columns_, row, column, dt_s_)
                              : turned_[row][column - kRotation];
  }

  /// The same as GuessAt() for rows that each continue the one above.
  void AddDistances(std::span<const Word> words, Guess guess) {
    const std::size_t begin = distances_.size();
    distances_.resize(begin + words.size() - 1);
    const std::span<Word> to = std::span(distances_).subspan(begin);
    switch (guess) {
      case Guess::kLinear:
        return PolynomialDistances<2>(words, to);
      case Guess::kSquare:
        return PolynomialDistances<3>(words, to);
      case Guess::kCube:
        return PolynomialDistances<4>(words, to);
      case Guess::kConstant:
      case Guess::kBefore:
      case Guess::kMotion:
      case Guess::kBeside:
        break;
    }
    for (std::size_t row = 1; row < words.size(); ++row)
      to[row - 1] = Distance(words[row], words[row - 1]);
  }

  template <std::size_t values>
  static void PolynomialDistances(std::span<const Word> words, std::span<Word> to) {
    const std::size_t few = std::min(values, words.size());
    for (std::size_t row = 1; row < few; ++row)
      to[row - 1] = Distance(words[row], PolynomialAt(words, row, row));
    for (std::size_t row = few; row < words.size(); ++row)
      to[row - 1] = Distance(words[row], PolynomialAt(words, row, values));
  }

  /// The guess of a row from so many rows above it, each of which continues the next one.
  static Word PolynomialAt(std::span<const Word> words, std::size_t row, std::size_t values) {
    double x[4] = {};  // the latest first
    for (std::size_t i = 0; i < values; ++i) x[i] = AsDouble(words[row - 1 - i]);
    const double guess = Polynomial(x, values);
    return std::isfinite(guess) ? AsWord(guess) : words[row - 1];
  }

  /// How many bits the distances have, of some rows.
  Word SampledBits(Guess guess, std::size_t column) const {
    constexpr std::size_t kSamples = 48;
    const std::size_t step = std::max<std::size_t>(1, columns_.rows / kSamples);
    Word bits = 0;
    const std::span<const Word> words = columns_.Column(column);
    const std::size_t values = guess == Guess::kBefore   ? 1
                               : guess == Guess::kLinear ? 2
                               : guess == Guess::kSquare ? 3
                               : guess == Guess::kCube   ? 4
                                                         : 0;
    if (!order_.IsGiven() && values > 0) {
      for (std::size_t row = std::max<std::size_t>(step - 1, 1); row < words.size(); row += step) {
        const Word guessed =
            values == 1 ? words[row - 1] : PolynomialAt(words, row, std::min(values, row));
        bits += static_cast<Word>(std::bit_width(Distance(words[row], guessed)));
      }
      return bits;
    }
    for (std::size_t row = step - 1; row < columns_.rows; row += step) {
      if (order_.Before(row) >= 0)
        bits += static_cast<Word>(
            std::bit_width(Distance(columns_.At(row, column), GuessOf(guess, column, row))));
    }
    return bits;
  }

  static void AppendWord(Word word, std::string& bytes) {
    for (int i = 0; i < 8; ++i) bytes += static_cast<char>(word >> (8 * i));
  }

  void AppendCoded(Guess guess, std::span<const Word> words, std::string& bytes) {
    Word all = 0;
    for (const Word distance : distances_) all |= distance;
    const int planes = (std::bit_width(all) + 7) / 8;
    bytes += static_cast<char>(guess);
    bytes += static_cast<char>(planes);
    for (std::size_t row = 0; row < words.size(); ++row) {
      if (order_.Before(row) < 0) AppendWord(words[row], bytes);
    }
    const std::size_t begin = bytes.size(), count = distances_.size();
    bytes.resize(begin + static_cast<std::size_t>(planes) * count);
    SplitPlanes(distances_, planes, bytes.data() + begin);
  }

  const Columns& columns_;
  Order order_;
  double dt_s_ = 0;
  bool is_motion_ = false;
  std::vector<std::array<Word, 4>> turned_;
  std::vector<Word> distances_;  ///< of the rows of a column that continue another one
};

class Decoder {
 public:
  Decoder(std::string_view& bytes, std::size_t rows, std::size_t width, const Guesses& guesses)
      : bytes_(bytes),
        columns_(rows, width),
        order_(guesses, rows),
        dt_s_(guesses.dt_s),
        is_motion_(IsMotion(columns_, guesses)),
        starts_(order_.Starts()),
        guess_(width, Guess::kConstant) {}

  std::optional<Columns> Run() {
    for (std::size_t column = 0; column < columns_.width; ++column) {
      if (!TakeDistances(column)) return std::nullopt;
    }
    for (std::size_t column = is_motion_ ? kVelocity : 0; column < columns_.width; ++column)
      Continue(column);
    if (is_motion_) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (guess_[axis] == Guess::kMotion)
          Move(axis);
        else
          Continue(axis);
      }
      Turn();
    }
    return std::move(columns_);
  }

 private:
  std::optional<Word> TakeWord() {
    if (bytes_.size() < 8) return std::nullopt;
    Word word = 0;
    for (int i = 0; i < 8; ++i) word |= Word{static_cast<std::uint8_t>(bytes_[i])} << (8 * i);
    bytes_.remove_prefix(8);
    return word;
  }

  /// Afterwards the column has the values of rows that continue none, and of the others the
  /// distances; a constant column is complete.
  bool TakeDistances(std::size_t column) {
    if (bytes_.empty()) return false;
    const auto guess = static_cast<std::uint8_t>(bytes_.front());
    bytes_.remove_prefix(1);
    if (guess > static_cast<std::uint8_t>(Guess::kBeside)) return false;
    guess_[column] = static_cast<Guess>(guess);
    if (guess_[column] == Guess::kMotion && !(is_motion_ && column < kVelocity)) return false;
    const std::span<Word> words = columns_.Column(column);
    if (guess_[column] == Guess::kConstant) {
      const std::optional<Word> word = TakeWord();
      if (word) std::ranges::fill(words, *word);
      return word.has_value();
    }
    if (bytes_.empty()) return false;
    const auto planes = static_cast<std::uint8_t>(bytes_.front());
    bytes_.remove_prefix(1);
    const std::size_t continued = words.size() - starts_;
    if (planes > 8 || bytes_.size() < 8 * starts_ + planes * continued) return false;
    for (std::size_t row = 0; row < words.size(); ++row) {
      if (order_.Before(row) < 0) words[row] = *TakeWord();
    }
    if (order_.IsGiven()) {
      joined_.resize(continued);
      JoinPlanes(bytes_.data(), planes, joined_);
      std::size_t next = 0;
      for (std::size_t row = 0; row < words.size(); ++row) {
        if (order_.Before(row) >= 0) words[row] = joined_[next++];
      }
    } else {
      JoinPlanes(bytes_.data(), planes, words.subspan(1));
    }
    bytes_.remove_prefix(static_cast<std::size_t>(planes) * continued);
    return true;
  }

  void Continue(std::size_t column) {
    if (guess_[column] == Guess::kConstant) return;
    const std::span<Word> words = columns_.Column(column);
    if (order_.IsRuns() && guess_[column] != Guess::kBeside) {
      order_.EachRun([&](std::size_t begin, std::size_t size) {
        ContinueRun(words.subspan(begin, size), guess_[column]);
      });
      return;
    }
    for (std::size_t row = 0; row < words.size(); ++row) {
      if (order_.Before(row) >= 0)
        words[row] = AtDistance(GuessAt(guess_[column], words, order_, row), words[row]);
    }
  }

  /// The same as GuessAt() for rows that each continue the one above.
  static void ContinueRun(std::span<Word> words, Guess guess) {
    if (guess != Guess::kBefore) return ContinuePolynomial(words, guess);
    for (std::size_t row = 1; row < words.size(); ++row)
      words[row] = AtDistance(words[row - 1], words[row]);
  }

  static void ContinuePolynomial(std::span<Word> words, Guess guess) {
    const std::size_t values = guess == Guess::kLinear ? 2 : guess == Guess::kSquare ? 3 : 4;
    double x[4] = {AsDouble(words[0])};  // the last values, the latest first
    const auto go_on = [&](std::size_t begin, std::size_t end, const auto& next_of) {
      for (std::size_t row = begin; row < end; ++row) {
        const double next = next_of(row);
        words[row] = AtDistance(std::isfinite(next) ? AsWord(next) : words[row - 1], words[row]);
        x[3] = x[2];
        x[2] = x[1];
        x[1] = x[0];
        x[0] = AsDouble(words[row]);
      }
    };
    const std::size_t rows = words.size(), few = std::min(values, rows);
    go_on(1, few, [&](std::size_t row) { return Polynomial(x, row); });
    if (values == 2) go_on(few, rows, [&](std::size_t) { return Polynomial(x, 2); });
    if (values == 3) go_on(few, rows, [&](std::size_t) { return Polynomial(x, 3); });
    if (values == 4) go_on(few, rows, [&](std::size_t) { return Polynomial(x, 4); });
  }

  void Move(std::size_t axis) {
    const std::span<Word> words = columns_.Column(axis);
    for (std::size_t row = 1; row < words.size(); ++row)
      words[row] = AtDistance(MovedGuess(columns_, row, axis, dt_s_), words[row]);
  }

  /// The columns of a quaternion depend on each other, so all go from row to row together.
  void Turn() {
    bool turned = false;
    for (std::size_t i = kRotation; i < kVelocity; ++i) turned |= guess_[i] == Guess::kMotion;
    if (!turned) {
      for (std::size_t i = kRotation; i < kVelocity; ++i) Continue(i);
      return;
    }
    for (std::size_t row = 1; row < columns_.rows; ++row) {
      const std::array<Word, 4> guess = TurnedGuess(columns_, row, dt_s_);
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t column = kRotation + i;
        Word& word = columns_.At(row, column);
        if (guess_[column] == Guess::kConstant) continue;
        word = AtDistance(guess_[column] == Guess::kMotion
                              ? guess[i]
                              : GuessAt(guess_[column], columns_.Column(column), order_, row),
                          word);
      }
    }
  }

  std::string_view& bytes_;
  Columns columns_;
  Order order_;
  double dt_s_ = 0;
  bool is_motion_ = false;
  std::size_t starts_ = 0;
  std::vector<Guess> guess_;
  std::vector<Word> joined_;
};

}  // namespace

void Encode(const Columns& columns, const Guesses& guesses, std::string& bytes) {
  if (columns.rows == 0) return;
  Encoder encoder(columns, guesses);
  for (std::size_t column = 0; column < columns.width; ++column) encoder.Append(column, bytes);
}

std::optional<Columns> Decode(std::string_view& bytes, std::size_t rows, std::size_t width,
                              const Guesses& guesses) {
  if (rows == 0) return Columns(0, width);
  return Decoder(bytes, rows, width, guesses).Run();
}

void AppendVarint(Word value, std::string& bytes) {
  for (; value >= 128; value >>= 7) bytes += static_cast<char>(value | 128);
  bytes += static_cast<char>(value);
}

std::optional<Word> TakeVarint(std::string_view& bytes) {
  Word value = 0;
  for (int shift = 0; shift < 64 && !bytes.empty(); shift += 7) {
    const auto byte = static_cast<std::uint8_t>(bytes.front());
    bytes.remove_prefix(1);
    value |= Word{byte & 127u} << shift;
    if (byte < 128) return value;
  }
  return std::nullopt;
}

struct Compressor::State {
  int level = 1;
  ZSTD_CCtx* packing = nullptr;
  ZSTD_DCtx* unpacking = nullptr;
  std::string packed, unpacked;
  ~State() {
    ZSTD_freeCCtx(packing);
    ZSTD_freeDCtx(unpacking);
  }
};

Compressor::Compressor(int level) : state_(std::make_unique<State>()) { state_->level = level; }
Compressor::~Compressor() = default;
Compressor::Compressor(Compressor&&) noexcept = default;

std::string_view Compressor::Pack(std::string_view bytes) {
  State& state = *state_;
  if (!state.packing) state.packing = ZSTD_createCCtx();
  state.packed.resize(std::max(state.packed.size(), ZSTD_compressBound(bytes.size())));
  const std::size_t size =
      ZSTD_compressCCtx(state.packing, state.packed.data(), state.packed.size(), bytes.data(),
                        bytes.size(), state.level);
  return std::string_view(state.packed).substr(0, ZSTD_isError(size) ? 0 : size);
}

std::optional<std::string_view> Compressor::Unpack(std::string_view packed,
                                                   std::size_t most_bytes) {
  State& state = *state_;
  const auto size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN || size > most_bytes)
    return std::nullopt;
  if (!state.unpacking) state.unpacking = ZSTD_createDCtx();
  state.unpacked.resize(std::max<std::size_t>(state.unpacked.size(), size));
  const std::size_t found = ZSTD_decompressDCtx(state.unpacking, state.unpacked.data(), size,
                                                packed.data(), packed.size());
  if (ZSTD_isError(found) || found != size) return std::nullopt;
  return std::string_view(state.unpacked).substr(0, size);
}

}  // namespace prehend::episode
