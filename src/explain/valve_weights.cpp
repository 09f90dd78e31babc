// How the valve's residuals are weighed: the tuned model's error and each channel's memory (explain/valve.h).
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "explain/constants.h"
#include "explain/subject.h"
#include "explain/valve.h"
#include "fit/error_model.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "optimise/unit_cube.h"
#include "servodx/log.h"
#include "signals/signal.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

namespace k = explain_constants;

// All samples of a sweep on a stand count alike, as in `tune`.
void make_alike(std::vector<double>& sigma) {
  double square = 0;
  for (double s : sigma) square += s * s;
  std::fill(sigma.begin(), sigma.end(), std::sqrt(square / static_cast<double>(sigma.size())));
}

double travel_of(const Scenario& s) {
  double sum = 0;
  for (std::size_t k = 1; k < s.command.size(); ++k) sum += std::abs(s.command[k] - s.command[k - 1]);
  return sum / s.rated_current;
}

// Of an even number the mean of the two in the middle: of four logs the upper one would lean.
double middle_of(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v.empty() ? 0 : 0.5 * (v[v.size() / 2] + v[(v.size() - 1) / 2]);
}
double rate_of(const std::vector<double>& time) {
  return static_cast<double>(time.size() - 1) / (time.back() - time.front());
}

// Samples before which nothing is known: the first, and those about a gap.
std::vector<char> afresh_in(const std::vector<double>& measured) {
  std::vector<char> out(measured.size(), 0);
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = k == 0 || std::isnan(measured[k]) || std::isnan(measured[k - 1]);
  return out;
}

// What is usual of a channel on healthy logs, at the rate of this one; none where they are too few to tell. Its size is
// that of what a sample says beyond the one before.
struct UsualNews {
  double memory, size, effective;
};
std::optional<UsualNews> usual_news(const std::vector<UsualError>& healthy, const UsualError& of) {
  std::vector<UsualError> same;
  std::vector<double> memories, fractions, sizes;
  for (UsualError e : healthy)
    if (e.signal == of.signal) {
      e.memory = std::pow(e.memory, e.rate / of.rate);
      memories.push_back(e.memory), fractions.push_back(std::min(1.0, e.effective * e.rate / of.rate));
      same.push_back(e);
    }
  if (same.size() < k::enough_healthy) return {};
  const double a = middle_of(memories);
  for (const UsualError& e : same) sizes.push_back(e.size * std::sqrt(std::max(0.0, 1 - 2 * a * e.memory + a * a)));
  return UsualNews{a, middle_of(sizes), middle_of(fractions)};
}

// News of a channel: how large they are, and how much of them counts as independent.
struct News {
  double size, effective;
};
News news_of(const std::vector<double>& white) {
  double square = 0;
  for (double v : white) square += v * v;
  return {std::sqrt(square / static_cast<double>(white.size())), effective_fraction(white)};
}
// As they come out, and no larger than usual.
News at_most_usual(const News& own, const std::optional<UsualNews>& usual) {
  const bool larger = usual && usual->size > 0 && usual->size < own.size;
  return larger ? News{usual->size, usual->effective} : own;
}

}  // namespace

void ValveSubject::weigh_as_tuned() {
  std::vector<const LogData*> data;
  for (const LogData& l : logs_) data.push_back(&l);
  FitProblem whole(data, base_, free_, options_);
  apply_error_model(whole, error_, whole.start());
  for (std::size_t l = 0; l < logs_.size(); ++l) {
    auto& sigmas = sigma_.emplace_back();
    for (std::size_t c = 0; c < logs_[l].channels.size(); ++c) {
      sigmas.push_back(whole.sigma(static_cast<int>(l), static_cast<int>(c)));
      if (of_stand(l)) make_alike(sigmas.back());
    }
  }
  for (std::size_t l = 0; l < logs_.size(); ++l)
    for (std::size_t c = 0; c < logs_[l].channels.size(); ++c) add_series(l, c);
}

void ValveSubject::add_series(std::size_t log, std::size_t channel) {
  const FitChannel& of = logs_[log].channels[channel];
  const std::vector<double>&time = logs_[log].scenario.time, &sigma = sigma_[log][channel];
  const long first = series_.empty() ? 0 : series_.back().first + series_.back().count;
  const double effective = effective_of(error_.find(of.signal), time);
  series_.push_back({std::string(info(of.signal).name), std::string(info(of.signal).si_unit), static_cast<int>(log),
                     first, static_cast<long>(of.measured.size()), &time, &sigma, of.noise, effective});
  tuned_sigma_.push_back(sigma);
  for (double& v : tuned_sigma_.back()) v *= std::sqrt(effective);
  memory_.push_back(0.0);
  afresh_.push_back(afresh_in(of.measured));
}

// A row that nothing is known before has the variance of the whole series, not of its news.
void ValveSubject::remember(Eigen::Ref<Eigen::VectorXd> rows) const {
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const double alone = std::sqrt(1 - memory_[i] * memory_[i]);
    for (long k = series_[i].count - 1, at = series_[i].first + k; k >= 0; --k, --at)
      if (afresh_[i][static_cast<std::size_t>(k)])
        rows[at] *= alone;
      else
        rows[at] -= memory_[i] * rows[at - 1];
  }
}
void ValveSubject::forget(Eigen::Ref<Eigen::VectorXd> rows) const {
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const double alone = std::sqrt(1 - memory_[i] * memory_[i]);
    for (long k = 0, at = series_[i].first; k < series_[i].count; ++k, ++at)
      if (afresh_[i][static_cast<std::size_t>(k)])
        rows[at] /= alone;
      else
        rows[at] += memory_[i] * rows[at - 1];
  }
}

Eigen::VectorXd ValveSubject::physical(const Eigen::VectorXd& rows) const {
  Eigen::VectorXd plain = rows;
  forget(plain);
  return Subject::physical(plain);
}

Eigen::VectorXd ValveSubject::in_tuned_errors(const Eigen::VectorXd& rows) const {
  Eigen::VectorXd r = physical(rows);
  for (std::size_t i = 0; i < series_.size(); ++i)
    for (long k = 0; k < series_[i].count; ++k) r[series_[i].first + k] /= tuned_sigma_[i][static_cast<std::size_t>(k)];
  return r;
}

std::vector<UsualError> ValveSubject::errors(const Eigen::VectorXd& rows) const {
  const Eigen::VectorXd r = in_tuned_errors(rows);
  std::vector<UsualError> out;
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const Series& s = series_[i];
    double square = 0, neighbours = 0;
    for (long k = 0, at = s.first; k < s.count; ++k, ++at) {
      square += r[at] * r[at];
      if (!afresh_[i][static_cast<std::size_t>(k)]) neighbours += r[at] * r[at - 1];
    }
    out.push_back({s.signal, std::sqrt(square / static_cast<double>(s.count)),
                   square > 0 ? std::clamp(neighbours / square, 0.0, k::longest_memory) : 0.0, s.effective,
                   rate_of(*s.time)});
  }
  return out;
}

std::vector<ValveSubject::PooledError> ValveSubject::pooled_errors(const Eigen::VectorXd& rows) const {
  std::vector<PooledError> out;
  std::vector<double> samples;
  const std::vector<UsualError> all = errors(rows);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const UsualError& e = all[i];
    std::size_t at = 0;
    while (at < out.size() && out[at].signal != e.signal) ++at;
    if (at == out.size()) out.push_back({e.signal}), samples.push_back(0);
    const auto n = static_cast<double>(series_[i].count);
    out[at].whole += n * e.size * e.size;
    out[at].news += n * e.size * e.size * (1 - e.memory * e.memory);
    samples[at] += n;
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].whole = std::sqrt(out[i].whole / samples[i]);
    out[i].news = std::sqrt(out[i].news / samples[i]);
  }
  return out;
}

std::vector<Miss> ValveSubject::misses(const Eigen::VectorXd& rows) const {
  std::vector<Miss> out;
  for (const PooledError& e : pooled_errors(rows)) {
    out.push_back({e.signal, e.whole});
    out.push_back({e.signal + ", news", e.news});
  }
  return out;
}

double ValveSubject::adequacy(const Eigen::VectorXd& rows) const {
  double sum = 0, channels = 0;
  for (const PooledError& e : pooled_errors(rows)) sum += e.whole * e.whole, ++channels;
  return sum / std::max(1.0, channels);
}

// The channel's own size and memory; where healthy logs tell what is usual, their memory, and no larger size.
bool ValveSubject::rescale(const Eigen::VectorXd& rows) {
  Eigen::VectorXd white = in_tuned_errors(rows);
  const std::vector<UsualError> own = errors(rows);
  std::vector<std::optional<UsualNews>> usual(series_.size());
  for (std::size_t i = 0; i < series_.size(); ++i) {
    if (known_) usual[i] = usual_news(known_->errors, own[i]);
    const double own_memory = of_stand(static_cast<std::size_t>(series_[i].log)) ? 0.0 : own[i].memory;
    memory_[i] = usual[i] ? usual[i]->memory : own_memory;
  }
  remember(white);
  std::size_t i = 0;
  for (auto& log : sigma_)
    for (auto& sigma : log) {
      Series& s = series_[i];
      const News news = at_most_usual(news_of({white.data() + s.first, white.data() + s.first + s.count}), usual[i]);
      s.effective = news.effective;
      if (const auto l = static_cast<std::size_t>(s.log); of_stand(l)) {
        const double points = travel_of(logs_[l].scenario) / k::sweep_detail;
        s.effective = std::clamp(points / static_cast<double>(s.count), s.effective, 1.0);
      }
      for (std::size_t k = 0; k < sigma.size(); ++k)
        sigma[k] = std::max(tuned_sigma_[i][k] * news.size, s.noise) / std::sqrt(s.effective);
      ++i;
    }
  return true;
}

}  // namespace servodx
