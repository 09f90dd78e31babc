#include "set.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <utility>

#include "base/random.h"
#include "condition.h"
#include "excite.h"
#include "faults.h"

namespace servodx::foreign {
namespace {

constexpr int repeats = 12, suspects = 6, controls = 4, sudden_faults = 8;

enum Stream : std::uint32_t {
  healthy_stream = 10,
  acceptance_stream,
  fault_stream,
  sudden_stream,
  hidden_stream,
  pair_stream
};

class Planner {
 public:
  explicit Planner(const Design& d) : d_(d) {}

  std::vector<Planned> take() { return std::move(made_); }

  // In an order whose odd and even halves both hold steps, a spectrum and a closed loop.
  void assorted() {
    constexpr std::array tests = {std::pair{Trial::steps_large, "steps_large"},
                                  std::pair{Trial::steps_small, "steps_small"},
                                  std::pair{Trial::multisine, "multisine"},
                                  std::pair{Trial::multisine, "multisine_warm_air"},
                                  std::pair{Trial::flight, "flight"},
                                  std::pair{Trial::flight_dropped, "flight_dropped"},
                                  std::pair{Trial::sine, "sine"},
                                  std::pair{Trial::steps_large, "steps_cold"},
                                  std::pair{Trial::prbs, "prbs"},
                                  std::pair{Trial::prbs_jittered, "prbs_jitter"},
                                  std::pair{Trial::triangle, "triangle_full"},
                                  std::pair{Trial::slow_track, "slow_track"}};
    for (std::uint32_t i = 0; i < tests.size(); ++i) {
      Random r(d_.seed, healthy_stream, i);
      Condition c = draw_condition(d_, r, true);
      if (i == 3) c.air = r.uniform(0.015, 0.03), c.celsius = d_.oil.flight ? 65.0 : 58.0;
      if (i == 7) c.celsius = d_.oil.flight ? -15.0 : 16.0;
      add(healthy_row(fmt::format("healthy/h{:02}_{}.csv", i + 1, tests[i].second)),
          {make_excitation(d_, tests[i].first, Random(d_.seed, healthy_stream, i, 1)), c});
    }
  }

  void acceptance() {
    for (int i = 0; i < repeats; ++i) {
      Random r(d_.seed, acceptance_stream, i);
      add(healthy_row(fmt::format("healthy/a{:02}_acceptance.csv", i + 1)), {accept(), draw_condition(d_, r, false)});
    }
  }

  // One valve state in two logs; the states are shuffled, so that a number says nothing.
  void faulty() {
    struct State {
      const Fault* fault;
      std::string_view severity;
      double value;
    };
    std::vector<State> states(suspects, State{nullptr, "none", 0.0});
    for (const Fault& f : faults()) {
      states.push_back({&f, "mild", f.mild});
      states.push_back({&f, "medium", f.medium});
      states.push_back({&f, "severe", f.severe});
    }
    shuffle(states, fault_stream);
    for (std::uint32_t i = 0; i < states.size(); ++i) {
      Random r(d_.seed, fault_stream, i);
      Condition c = draw_condition(d_, r, false);
      const State& s = states[i];
      if (s.fault) s.fault->apply(c, d_, s.value);
      for (const bool closed : {false, true}) {
        Truth t = {path("fault/f", i, closed),
                   "fault",
                   s.fault ? s.fault->name : "healthy",
                   std::string(s.severity),
                   s.fault ? severity_value(*s.fault, d_, s.value) : 0.0,
                   true,
                   "",
                   -1.0,
                   ""};
        add(t, {closed ? flight(fault_stream, i) : accept(), c});
      }
    }
  }

  void stepping_in() {
    std::vector<const Fault*> chosen;
    for (const Fault& f : faults()) chosen.push_back(&f);
    shuffle(chosen, sudden_stream);
    for (std::uint32_t i = 0; i < sudden_faults; ++i) {
      Random r(d_.seed, sudden_stream, i);
      const bool closed = i % 2 == 0;
      Job job = {
          closed ? flight(sudden_stream, i) : make_excitation(d_, Trial::mixed, Random(d_.seed, sudden_stream, i, 1)),
          draw_condition(d_, r, false)};
      job.onset = job.excitation.duration * r.uniform(0.4, 0.6);
      job.later = job.condition;
      const double value = 0.5 * (chosen[i]->medium + chosen[i]->severe);
      chosen[i]->apply(*job.later, d_, value);
      const Truth t = {fmt::format("sudden/s{:02}.csv", i + 1),
                       "sudden",
                       chosen[i]->name,
                       "sudden",
                       severity_value(*chosen[i], d_, value),
                       true,
                       "",
                       job.onset,
                       ""};
      add(t, job);
    }
  }

  // Two faults of the valve at medium severity, no two of them alike in what they move.
  void pairs() {
    constexpr std::size_t of_valve = 7, count = 8;
    std::vector<std::pair<const Fault*, const Fault*>> all;
    for (std::size_t a = 0; a < of_valve; ++a)
      for (std::size_t b = a + 1; b < of_valve; ++b) all.push_back({&faults()[a], &faults()[b]});
    shuffle(all, pair_stream);
    for (std::uint32_t i = 0; i < count; ++i) {
      Random r(d_.seed, pair_stream, i);
      Condition c = draw_condition(d_, r, false);
      const auto [first, second] = all[i];
      for (const Fault* f : {first, second}) f->apply(c, d_, f->medium);
      for (const bool closed : {false, true}) {
        Truth t = {
            path("pair/p", i, closed), "pair", first->name + "+" + second->name, "pair", 0.0, false, "", -1.0, ""};
        add(t, {closed ? flight(pair_stream, i) : accept(), c});
      }
    }
  }

  // From the start in the acceptance test, stepping in on a mixed one.
  void electric() {
    for (std::uint32_t i = 0; i < electrics().size(); ++i) {
      const Electric& e = electrics()[i];
      Random r(d_.seed, pair_stream, 100 + i);
      const Condition healthy = draw_condition(d_, r, false);
      Condition broken = healthy;
      e.apply(broken);
      for (const bool later : {false, true}) {
        Job job = {later ? make_excitation(d_, Trial::mixed, Random(d_.seed, pair_stream, 100 + i, 1)) : accept(),
                   later ? healthy : broken};
        Truth t = {fmt::format("electric/e{:02}_{}.csv", i + 1, later ? "sudden" : "whole"),
                   "electric",
                   e.name,
                   later ? "sudden" : "whole",
                   e.value,
                   true,
                   "",
                   -1.0,
                   e.channel};
        if (later) t.onset = job.onset = job.excitation.duration * r.uniform(0.4, 0.6), job.later = broken;
        add(t, job);
      }
    }
  }

  void hidden() {
    struct Case {
      const Effect* effect;
      double share;
    };
    std::vector<Case> cases(controls, Case{nullptr, 0.0});
    for (const Effect& e : effects()) {
      cases.push_back({&e, 1.0});
      cases.push_back({&e, 1.0 / 3.0});
    }
    shuffle(cases, hidden_stream);
    for (std::uint32_t i = 0; i < cases.size(); ++i) {
      Random r(d_.seed, hidden_stream, i);
      Condition c = draw_condition(d_, r, false);
      Truth t = {"", "hidden", "control", "", 0.0, false, "none", -1.0, ""};
      if (const Effect* e = cases[i].effect) {
        t.kind = "hidden_effect";
        t.effect = e->name;
        t.severity_value = e->apply(c, d_, cases[i].share, r);
        t.with_value = true;
        t.size = cases[i].share == 1.0 ? "full" : "third";
      }
      for (const bool closed : {false, true}) {
        t.path = path("hidden/c", i, closed);
        add(t, {closed ? flight(hidden_stream, i)
                       : make_excitation(d_, Trial::mixed, Random(d_.seed, hidden_stream, i, 1)),
                c});
      }
    }
  }

 private:
  static std::string path(const char* start, std::uint32_t i, bool closed) {
    return fmt::format("{}{:02}_{}.csv", start, i + 1, closed ? "closed" : "open");
  }
  static Truth healthy_row(std::string path) {
    return {std::move(path), "healthy", "healthy", "none", 0.0, true, "", -1.0, ""};
  }
  Excitation accept() const { return make_excitation(d_, Trial::acceptance, Random(d_.seed)); }
  Excitation flight(Stream stream, std::uint32_t i) const {
    return make_excitation(d_, Trial::flight, Random(d_.seed, stream, i, 2));
  }
  template <class T>
  void shuffle(std::vector<T>& list, Stream stream) const {
    Random r(d_.seed, stream, 1000);
    for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[r.below(static_cast<std::uint32_t>(i))]);
  }
  void add(Truth truth, Job job) {
    // A log's noise hangs on its name alone, so it is the same whatever else is asked for.
    std::uint32_t hash = 2166136261u;
    for (const char c : truth.path) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
    job.noise = hash;
    made_.push_back({std::move(truth), std::move(job)});
  }

  const Design& d_;
  std::vector<Planned> made_;
};

}  // namespace

std::vector<Planned> plan(const Design& design, const Wanted& wanted) {
  Planner planner(design);
  if (wanted.healthy && wanted.assorted) planner.assorted();
  if (wanted.healthy && wanted.acceptance) planner.acceptance();
  if (wanted.fault) planner.faulty();
  if (wanted.fault) planner.stepping_in();
  if (wanted.hidden) planner.hidden();
  if (wanted.pair) planner.pairs();
  if (wanted.pair) planner.electric();
  return planner.take();
}

}  // namespace servodx::foreign
