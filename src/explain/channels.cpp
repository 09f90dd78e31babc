#include "explain/channels.h"

#include <cmath>
#include <cstddef>

#include "explain/subject.h"

namespace servodx {
namespace {

double square_sum(const Eigen::VectorXd& physical, const Series& s) {
  return physical.segment(s.first, s.count).squaredNorm();
}

struct Sum {
  double before = 0, after = 0, noise = 0, held_before = 0, held_after = 0, samples = 0;
};

std::size_t position_of(const Series& s, const std::vector<Log>& logs, std::vector<ExplainedChannel>& channels) {
  const auto signal = find_signal(s.signal);
  std::size_t at = 0;
  while (at < channels.size() && channels[at].id != signal) ++at;
  if (at == channels.size()) {
    channels.push_back({s.signal, logs[static_cast<std::size_t>(s.log)].channels[index(*signal)].unit});
    channels.back().id = signal;
  }
  return at;
}

}  // namespace

std::vector<ExplainedChannel> explained_channels(const Subject& subject, const std::vector<Log>& logs,
                                                 const FoundCauses& found) {
  std::vector<ExplainedChannel> out;
  std::vector<Sum> sums;
  const Eigen::VectorXd before = subject.physical(found.before.residual);
  const Eigen::VectorXd after = subject.physical(found.after.residual);
  for (const Series& s : subject.series()) {
    const std::size_t at = position_of(s, logs, out);
    sums.resize(out.size());
    Sum& sum = sums[at];
    const auto samples = static_cast<double>(s.count);
    sum.samples += samples;
    sum.noise += samples * s.noise * s.noise;
    sum.before += square_sum(before, s);
    sum.after += square_sum(after, s);
    if (found.before.heldout_residual.size() > 0) sum.held_before += square_sum(found.before.heldout_residual, s);
    if (found.after.heldout_residual.size() > 0) sum.held_after += square_sum(found.after.heldout_residual, s);
  }
  for (std::size_t k = 0; k < out.size(); ++k) {
    const auto rms = [&](double square) { return std::sqrt(square / sums[k].samples); };
    out[k].rms_before = rms(sums[k].before), out[k].rms_after = rms(sums[k].after);
    out[k].noise_rms = rms(sums[k].noise);
    out[k].heldout_before = rms(sums[k].held_before), out[k].heldout_after = rms(sums[k].held_after);
  }
  return out;
}

}  // namespace servodx
