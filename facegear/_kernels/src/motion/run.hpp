// Run machines over whole mesh periods, as many at a time as the layout holds.
//
// Each machine has its own phase and step, so that it switches contacts where it does alone; the next machine
// enters as soon as one is done. Lanes that have none repeat the first, and nothing is kept of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "motion/advance.hpp"
#include "motion/dense.hpp"
#include "motion/log.hpp"
#include "motion/sums.hpp"
#include "motion/tangents.hpp"

namespace facegear::motion {

// Machines of one structure that wait for a lane.
struct Queue {
    std::vector<Machine> machines;
    std::vector<double> starts;  // (machines, 2, n): coordinates and their derivatives by phase
    std::vector<Index> periods;  // of each
    std::vector<double> longest; // step, rad, of each
    double begin = 0.0;          // phase at which the first period is entered; 0 where samples are asked for
    std::vector<double> drift;   // (terms, m) added to the error in every period, by powers of the phase
    bool (*stop)() = nullptr;    // asked every `between_looks` steps: true ends the run
};

// Steps between two looks at Queue::stop: some 0.05 s, which no user notices, and so rare that it costs
// nothing.
constexpr Index between_looks = 16384;

// What runs machines of one structure with a layout and a law.
class AnyRunner {
  public:
    virtual ~AnyRunner() = default;
    virtual const System& system() const = 0;
    virtual Index order() const = 0;
    // Run every machine of a queue over its periods; log.tangents holds the disturbances, and is written.
    // False if the run was stopped before its end.
    virtual bool run(const Queue& queue, Log& log) = 0;
    // Second derivatives (n,) by phase of the first machine, at a phase and a state (2, n).
    virtual void accelerations(const Machine& machine, double phase, const double* state, double* out) = 0;
};

// Scratch space of runs, and what they add up.
template <class L, class Law>
class Runner final : public AnyRunner {
    using S = typename L::S;
    static constexpr Index none = -1;

  public:
    Runner(const std::shared_ptr<const System>& system, Index order, const std::vector<double>& nodes,
           const std::vector<double>& weights)
        : work_(system, order), tally_(system->n, system->m, nodes, weights) {}

    const System& system() const override { return *work_.shape; }
    Index order() const override { return work_.order; }

    bool run(const Queue& queue, Log& log) override {
        queue_ = &queue;
        log_ = &log;
        make_tangents();
        const bool all = Law::curved && (log.asked.fine || (Law::ahead_by_forces && log.asked.batches > 0));
        work_.last_force = work_.order - (all ? 0 : work_.shape->push_only ? 1 : 2);
        work_.drift_terms = static_cast<Index>(queue.drift.size()) / work_.m;
        work_.drift = queue.drift.data();
        work_.choose_error();
        waiting_ = running_ = 0;
        for (int lane = 0; lane < L::machines; ++lane) refill(lane);
        for (Index steps = 1; running_ > 0; ++steps) {
            if (queue.stop && steps % between_looks == 0 && queue.stop()) return false;
            step();
        }
        return true;
    }

    void accelerations(const Machine& machine, double phase, const double* state, double* out) override {
        const Index n = work_.n;
        work_.enter(machine, 0);
        work_.drift_terms = 0;
        work_.choose_error();
        work_.phase = S::splat(phase);
        for (Index row = 0; row < 2; ++row)
            for (Index k = 0; k < n; ++k) work_.y.one(row, k, 0) = state[row * n + k];
        start_step(work_);
        recurrence(work_, 0, 1, work_.y, work_.deflection, false);
        for (Index k = 0; k < n; ++k) out[k] = 2.0 * work_.y.one(2, k, 0);
    }

  private:
    void step() {
        const Asked& asked = log_->asked;
        advance(work_);
        if (asked.fine) {
            work_.law.expand_slopes(work_.touching.deflections(work_.deflection, false), work_.order);
            shorten_for_tangents(work_);
        }
        if (asked.columns > 0) {
            switch_tangents(work_, tangents_);
            keep_acting(work_);
            work_.rings.expand_slopes(work_.order);
            move_tangents(work_, tangents_, block_.get());
            divergence_ = divergence_ + divergence(work_);
        }
        if (asked.batches > 0) add_step(work_, tally_);
        if (!log_->fractions.empty()) add_fractions(work_, tally_);
        if (asked.per_period > 0) sample();
        if (asked.turns > 0) add_turning_points(work_, *log_);
        if (log_->taken[0] + taken_[0] < asked.steps) keep_step(work_, log_->taken[0] + taken_[0], *log_);
        move_ahead(work_.y, work_.order, work_.length, work_.y, 0, 1);
        work_.fresh = S::splat(0.0);
        for (int lane = 0; lane < L::machines; ++lane) {
            if (!at_end(lane)) continue;
            --running_;
            refill(lane);
        }
    }

    // Give a lane the next machine.
    void refill(int lane) {
        const bool any = waiting_ < static_cast<Index>(queue_->machines.size());
        enter(lane, any ? waiting_ : 0);
        number_[lane] = any ? waiting_++ : none;
        running_ += any;
    }

    // Put a machine at its start into a lane.
    void enter(int lane, Index number) {
        const Index n = work_.n, columns = log_->asked.columns;
        work_.enter(queue_->machines[number], lane);
        for (Index row = 0; row < 2; ++row)
            for (Index k = 0; k < n; ++k)
                work_.y.one(row, k, lane) = queue_->starts[(2 * number + row) * n + k];
        for (Index row = 0; row < 2 * columns; ++row)
            for (Index k = 0; k < n; ++k)
                tangents_.table.one(row, k, lane) = log_->tangents[(2 * columns * number + row) * n + k];
        if (!log_->fractions.empty()) clear_tally(tally_, lane, n, work_.m);
        work_.longest.set(lane, queue_->longest[number]);
        work_.fresh.set(lane, 1.0);
        work_.phase.set(lane, queue_->begin);
        divergence_.set(lane, 0.0);
        period_[lane] = taken_[lane] = sampled_[lane] = 0;
    }

    // Write the coordinates at all samples that lie within the steps, one of each machine at a time.
    void sample() {
        const Index per_period = log_->asked.per_period, n = work_.n;
        while (true) {
            S ahead = S::splat(0.0);
            bool due[L::machines], any = false;
            for (int lane = 0; lane < L::machines; ++lane) {
                const double to =
                    tau * static_cast<double>(sampled_[lane]) / static_cast<double>(per_period) -
                    work_.phase[lane];
                due[lane] = number_[lane] != none && sampled_[lane] < per_period && to < work_.length[lane];
                any = any || due[lane];
                ahead.set(lane, due[lane] ? to : 0.0);
            }
            if (!any) return;
            look_ahead(work_, ahead);
            for (int lane = 0; lane < L::machines; ++lane) {
                if (!due[lane]) continue;
                const Index row =
                    (number_[lane] * log_->longest + period_[lane]) * per_period + sampled_[lane]++;
                write_row(work_.sample, 0, n, lane, log_->samples.data() + row * n);
            }
        }
    }

    // Move the phase of a lane; at the end of a period write what is asked for. True if its machine is done.
    bool at_end(int lane) {
        const double phase = work_.phase[lane] + work_.length[lane];
        const Index number = number_[lane];
        const bool stuck = number != none && ++taken_[lane] > max_steps;
        if (tau - phase >= rounding && !stuck) {
            work_.phase.set(lane, phase);
            return false;
        }
        work_.phase.set(lane, 0.0);
        const double grown = log_->asked.growth ? shorten(work_, tangents_.table, lane) : 1.0;
        if (number == none) return false;
        if (log_->asked.growth) log_->growth[number * log_->longest + period_[lane]] = std::log(grown);
        const bool finite = keep_end(lane, number);
        log_->taken[number] += taken_[lane];
        ++period_[lane];
        taken_[lane] = sampled_[lane] = 0;
        const Status status = stuck ? Status::too_many_steps : finite ? Status::done : Status::not_finite;
        log_->status[number] = static_cast<Index>(status);
        const bool done = period_[lane] == queue_->periods[number];
        keep_sums(lane, number, done);
        return status != Status::done || done;
    }

    // Write what was added up where a batch of periods, or the last of them, is over.
    void keep_sums(int lane, Index number, bool done) {
        const Index run = period_[lane], periods = queue_->periods[number], batches = log_->asked.batches;
        const Index batch = (run - 1) * batches / periods;
        if (batches > 0 && run * batches / periods > batch) {
            keep_batch(tally_, lane, number, batch, *log_);
            clear_batch(tally_, lane, work_.n, work_.m);
        }
        if (!done) return;
        keep_whole(tally_, lane, number, *log_);
        log_->divergence[number] = divergence_[lane];
        const Index rows = 2 * log_->asked.columns, n = work_.n;
        for (Index row = 0; row < rows; ++row)
            write_row(tangents_.table, row, n, lane, log_->tangents.data() + (rows * number + row) * n);
    }

    // Write the state at the end of a period if it is one of the last; false if it has grown beyond all
    // bounds.
    bool keep_end(int lane, Index number) {
        const Index kept = log_->asked.kept, n = work_.n;
        const Index row = period_[lane] - std::max(queue_->periods[number] - kept, Index{0});
        double size = 0.0;
        for (Index k = 0; k < n; ++k)
            size += work_.weights.one(0, k, lane) *
                    (std::fabs(work_.y.one(0, k, lane)) + std::fabs(work_.y.one(1, k, lane)));
        for (Index i = 0; row >= 0 && i < 2; ++i)
            write_row(work_.y, i, n, lane, log_->ends.data() + ((number * kept + row) * 2 + i) * n);
        return size <= largest_amplitude * work_.scale[lane];
    }

    void make_tangents() {
        const Index columns = log_->asked.columns;
        if (columns == tangents_.columns) return;
        tangent_room_ = Room{};
        tangents_ = {tangent_room_.template table<L>(2 * columns, work_.n), columns};
        if (L::machines == 1 && columns > 1 && !block_)
            block_ = std::make_unique<Block<L::lanes>>(work_.rows, work_.n, work_.m);
    }

    Work<L, Law> work_;
    Tally<L> tally_;
    Room tangent_room_;
    Tangents<L> tangents_;
    std::unique_ptr<Block<L::lanes>> block_;
    const Queue* queue_ = nullptr;
    Log* log_ = nullptr;
    Index waiting_ = 0, running_ = 0;
    S divergence_ = S::splat(0.0);
    // Of the machine in a lane: its number, the periods it has run, steps and samples of this one.
    Index number_[L::machines] = {}, period_[L::machines] = {}, taken_[L::machines] = {},
          sampled_[L::machines] = {};
};

} // namespace facegear::motion
