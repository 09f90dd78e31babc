// What a check is called, and by that what it measures. A history keeps the text; code asks for the kind and the row.
#pragma once
#include <compare>
#include <optional>
#include <string>

namespace servodx {

enum class CheckKind {
  mean_error,   // |e| in service
  fidelity,     // r of a step
  correlation,  // E(tau) of a sine
  parameter,    // a tracked row of the table
  other,        // a figure of another origin
};

class CheckName {
 public:
  CheckName() = default;
  CheckName(std::string text);
  CheckName(const char* text) : CheckName(std::string(text)) {}
  static CheckName of_mean_error();
  static CheckName of_fidelity();
  static CheckName of_correlation(double frequency);  // [Hz], told in steps of a twentieth
  static CheckName of_row(int row);                   // position in the table, 0 to 40

  const std::string& text() const { return text_; }
  CheckKind kind() const { return kind_; }
  // Of a parameter; none where its text names no row of the table.
  std::optional<int> row() const { return row_; }
  // What follows the kind's own part of the text: a row's id, a sine's frequency.
  std::string detail() const;

  bool operator==(const CheckName& other) const { return text_ == other.text_; }
  std::strong_ordering operator<=>(const CheckName& other) const { return text_ <=> other.text_; }

 private:
  std::string text_;
  CheckKind kind_ = CheckKind::other;
  std::optional<int> row_;
};

}  // namespace servodx
