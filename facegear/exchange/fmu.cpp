// Dynamic model of a facegear machine as an FMU for co-simulation (FMI 3.0), C++17.
//
// The motion is that of facegear itself: motion/ and simd.hpp are its sources, one machine and one number in
// a vector, without extensions of a compiler. model.hpp holds the numbers of the machine. Time is counted as
// mesh phase s = w t.
#define FACEGEAR_SCALAR

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include "model.hpp"
#include "motion/advance.hpp"

#if defined(_WIN32)
#define EXPORT extern "C" __declspec(dllexport)
#else
#define EXPORT extern "C"
#endif

namespace {

using namespace facegear::motion;

enum Status : int { OK, WARNING, DISCARD, ERROR, FATAL };
using Reference = std::uint32_t;
using Layout = Machines<1>;

// Of the variables; reference 0 is the time.
constexpr std::size_t inputs = 1 + model::bodies, first_output = 1 + inputs;

// A machine in motion.
class Instance {
  public:
    Instance() : system_(std::make_shared<System>(model::make_system())), work_(system_, model::order) {
        work_.choose_error();
        base_load_ = system_->load.values;
        output_.resize(2 * system_->contacts + 3 * model::bodies);
        begin();
    }

    // At rest under the torques of the machine.
    void begin() {
        time = 0.0;
        phase_ = behind_ = 0.0;
        input_ = model::start_input();
        displacement_ = model::start_coordinates();
        velocity_.assign(displacement_.size(), 0.0);
        observed_ = false;
    }

    // Speed in rpm, or the torque on a body in N m; false for what the motion cannot take.
    bool set(std::size_t number, double value) {
        if (!std::isfinite(value) || (number == 0 && value < model::slowest)) return false;
        input_[number] = value;
        observed_ = false;
        return true;
    }
    double input(std::size_t number) const { return input_[number]; }

    // Deflections (m), then elastic forces (N) of all contacts, then forces of the bodies on their bearings
    // (N).
    double output(std::size_t number) {
        if (!observed_) observe();
        return output_[number];
    }
    std::size_t outputs() const { return output_.size(); }

    // Move on to a time in s; false, and where it was, if the motion is lost.
    bool move_to(double end) {
        enter();
        double left = rate() * (end - time) + behind_, phase = phase_;
        for (Index steps = 0; left > rounding; ++steps) {
            if (steps == max_steps) return false;
            work_.phase = Number::splat(phase);
            work_.longest = Number::splat(left);
            advance(work_);
            move_ahead(work_.y, work_.order, work_.length, work_.y, 0, 1);
            left -= work_.length[0];
            phase += work_.length[0];
            if (tau - phase < rounding) phase = 0.0;
        }
        double total = 0.0;
        for (Index k = 0; k < system_->n; ++k) total += work_.y.one(0, k, 0) + work_.y.one(1, k, 0);
        if (!std::isfinite(total)) return false;
        for (Index k = 0; k < system_->n; ++k) {
            displacement_[k] = work_.y.one(0, k, 0);
            velocity_[k] = work_.y.one(1, k, 0) * rate();
        }
        time = end;
        phase_ = phase;
        behind_ = left;
        observed_ = false;
        return true;
    }

    double time = 0.0; // s

  private:
    using Number = Layout::S;

    double rate() const { return tau * model::pinion_teeth * input_[0] / 60.0; } // w, rad/s

    // Put speed, torques and state into the scratch space of the steps.
    void enter() {
        std::vector<double>& load = system_->load.values;
        load = base_load_;
        const Index terms = system_->load.terms;
        for (Index k = 0; k < system_->n; ++k)
            for (Index body = 0; body < model::bodies; ++body)
                load[(2 * k + 1) * terms] += load_of_torque_[k * model::bodies + body] * input_[1 + body];
        work_.entered[0] = Machine{}; // the load is another, though the system is the same
        work_.enter(Machine{system_, rate(), model::tolerance, 1.0}, 0);
        for (Index k = 0; k < system_->n; ++k) {
            work_.y.one(0, k, 0) = displacement_[k];
            work_.y.one(1, k, 0) = velocity_[k] / rate();
        }
    }

    // Find all outputs here and now.
    void observe() {
        enter();
        work_.phase = Number::splat(phase_);
        work_.longest = Number::splat(infinity);
        start_step(work_);
        // The forces of the bearings with clearance.
        recurrence(work_, 0, 1, work_.y, work_.deflection, false);
        const Index contacts = system_->contacts;
        const double newton = rate() * rate();
        for (Index c = 0; c < contacts; ++c) {
            const double touching = std::fabs(work_.side.one(0, c, 0));
            output_[c] = work_.deflection.one(0, c, 0) + work_.edge.one(0, c, 0);
            output_[contacts + c] = newton * touching * work_.law.force(work_.deflection, 0, c)[0];
        }
        for (Index row = 0; row < 3 * model::bodies; ++row) {
            double force = 0.0;
            for (Index k = 0; k < system_->n; ++k)
                force += bearing_stiffness_[row * system_->n + k] * displacement_[k] +
                         bearing_damping_[row * system_->n + k] * velocity_[k];
            output_[2 * contacts + row] = force;
        }
        for (std::size_t r = 0; r < body_in_ring_.size(); ++r)
            for (Index along = 0; along < 2; ++along)
                output_[2 * contacts + 3 * body_in_ring_[r] + along] =
                    -2.0 * newton * work_.force.one(0, work_.rings.across(static_cast<Index>(r)) + along, 0);
        observed_ = true;
    }

    const std::vector<double> load_of_torque_ = model::load_of_torque(); // (n, bodies)
    const std::vector<double> bearing_stiffness_ = model::bearing_stiffness(),
                              bearing_damping_ = model::bearing_damping();
    const std::vector<Index> body_in_ring_ = model::body_in_ring();
    std::shared_ptr<System> system_;
    std::vector<double> base_load_; // without the torques
    Work<Layout, model::Law> work_;
    double phase_ = 0.0, behind_ = 0.0;                            // rad; what the last step left to this one
    std::vector<double> input_, displacement_, velocity_, output_; // velocities by time
    bool observed_ = false;
};

Instance& instance_of(void* pointer) { return *static_cast<Instance*>(pointer); }

} // namespace

EXPORT const char* fmi3GetVersion() { return "3.0"; }

EXPORT void* fmi3InstantiateCoSimulation(const char*, const char* token, const char*, bool, bool, bool, bool,
                                         const Reference*, std::size_t, void*, void*, void*) {
    if (token == nullptr || std::strcmp(token, model::token) != 0) return nullptr;
    try {
        return std::make_unique<Instance>().release();
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}

EXPORT void fmi3FreeInstance(void* instance) {
    std::unique_ptr<Instance>(static_cast<Instance*>(instance)).reset();
}

EXPORT Status fmi3Reset(void* instance) {
    instance_of(instance).begin();
    return OK;
}

EXPORT Status fmi3EnterInitializationMode(void* instance, bool, double, double start, bool, double) {
    instance_of(instance).time = start;
    return OK;
}

EXPORT Status fmi3SetFloat64(void* instance, const Reference* references, std::size_t count,
                             const double* values, std::size_t number) {
    if (count != number) return ERROR;
    for (std::size_t i = 0; i < count; ++i)
        if (references[i] < 1 || references[i] > inputs ||
            !instance_of(instance).set(references[i] - 1, values[i]))
            return ERROR;
    return OK;
}

EXPORT Status fmi3GetFloat64(void* instance, const Reference* references, std::size_t count, double* values,
                             std::size_t number) {
    Instance& machine = instance_of(instance);
    if (count != number) return ERROR;
    for (std::size_t i = 0; i < count; ++i) {
        const Reference wanted = references[i];
        if (wanted >= first_output + machine.outputs()) return ERROR;
        values[i] = wanted == 0             ? machine.time
                    : wanted < first_output ? machine.input(wanted - 1)
                                            : machine.output(wanted - first_output);
    }
    return OK;
}

EXPORT Status fmi3DoStep(void* instance, double time, double step, bool, bool* event, bool* terminate,
                         bool* early, double* last) {
    Instance& machine = instance_of(instance);
    *event = *terminate = *early = false;
    *last = machine.time;
    const double end = time + step;
    if (!(step > 0.0) || !std::isfinite(end) || end <= machine.time || !machine.move_to(end)) return ERROR;
    *last = machine.time;
    return OK;
}

// What this model does without, in two groups: nothing to do, and nothing to give.
#define DONE(name, ...) \
    EXPORT Status name(__VA_ARGS__) { return OK; }
#define NONE(name, ...) \
    EXPORT Status name(__VA_ARGS__) { return ERROR; }
DONE(fmi3SetDebugLogging, void*, bool, std::size_t, const char* const*)
DONE(fmi3ExitInitializationMode, void*)
DONE(fmi3EnterStepMode, void*)
DONE(fmi3EnterEventMode, void*)
DONE(fmi3EnterConfigurationMode, void*)
DONE(fmi3ExitConfigurationMode, void*)
DONE(fmi3Terminate, void*)
#define OTHER(type, name)                                                         \
    NONE(fmi3Get##name, void*, const Reference*, std::size_t, type*, std::size_t) \
    NONE(fmi3Set##name, void*, const Reference*, std::size_t, const type*, std::size_t)
OTHER(float, Float32)
OTHER(std::int8_t, Int8)
OTHER(std::uint8_t, UInt8)
OTHER(std::int16_t, Int16)
OTHER(std::uint16_t, UInt16)
OTHER(std::int32_t, Int32)
OTHER(std::uint32_t, UInt32)
OTHER(std::int64_t, Int64)
OTHER(std::uint64_t, UInt64)
OTHER(bool, Boolean)
OTHER(char*, String)
NONE(fmi3GetBinary, void*, const Reference*, std::size_t, std::size_t*, const std::uint8_t**, std::size_t)
NONE(fmi3SetBinary, void*, const Reference*, std::size_t, const std::size_t*, const std::uint8_t* const*,
     std::size_t)
NONE(fmi3GetClock, void*, const Reference*, std::size_t, bool*)
NONE(fmi3SetClock, void*, const Reference*, std::size_t, const bool*)
NONE(fmi3GetNumberOfVariableDependencies, void*, Reference, std::size_t*)
NONE(fmi3GetVariableDependencies, void*, Reference, std::size_t*, Reference*, std::size_t*, int*, std::size_t)
NONE(fmi3GetFMUState, void*, void**)
NONE(fmi3SetFMUState, void*, void*)
NONE(fmi3FreeFMUState, void*, void**)
NONE(fmi3SerializedFMUStateSize, void*, void*, std::size_t*)
NONE(fmi3SerializeFMUState, void*, void*, std::uint8_t*, std::size_t)
NONE(fmi3DeserializeFMUState, void*, const std::uint8_t*, std::size_t, void**)
NONE(fmi3GetDirectionalDerivative, void*, const Reference*, std::size_t, const Reference*, std::size_t,
     const double*, std::size_t, double*, std::size_t)
NONE(fmi3GetAdjointDerivative, void*, const Reference*, std::size_t, const Reference*, std::size_t,
     const double*, std::size_t, double*, std::size_t)
NONE(fmi3GetIntervalDecimal, void*, const Reference*, std::size_t, double*, int*)
NONE(fmi3GetIntervalFraction, void*, const Reference*, std::size_t, std::uint64_t*, std::uint64_t*, int*)
NONE(fmi3GetShiftDecimal, void*, const Reference*, std::size_t, double*)
NONE(fmi3GetShiftFraction, void*, const Reference*, std::size_t, std::uint64_t*, std::uint64_t*)
NONE(fmi3SetIntervalDecimal, void*, const Reference*, std::size_t, const double*)
NONE(fmi3SetIntervalFraction, void*, const Reference*, std::size_t, const std::uint64_t*,
     const std::uint64_t*)
NONE(fmi3SetShiftDecimal, void*, const Reference*, std::size_t, const double*)
NONE(fmi3SetShiftFraction, void*, const Reference*, std::size_t, const std::uint64_t*, const std::uint64_t*)
NONE(fmi3EvaluateDiscreteStates, void*)
NONE(fmi3UpdateDiscreteStates, void*, bool*, bool*, bool*, bool*, bool*, double*)
NONE(fmi3EnterContinuousTimeMode, void*)
NONE(fmi3CompletedIntegratorStep, void*, bool, bool*, bool*)
NONE(fmi3SetTime, void*, double)
NONE(fmi3SetContinuousStates, void*, const double*, std::size_t)
NONE(fmi3GetContinuousStateDerivatives, void*, double*, std::size_t)
NONE(fmi3GetEventIndicators, void*, double*, std::size_t)
NONE(fmi3GetContinuousStates, void*, double*, std::size_t)
NONE(fmi3GetNominalsOfContinuousStates, void*, double*, std::size_t)
NONE(fmi3GetNumberOfEventIndicators, void*, std::size_t*)
NONE(fmi3GetNumberOfContinuousStates, void*, std::size_t*)
NONE(fmi3GetOutputDerivatives, void*, const Reference*, std::size_t, const std::int32_t*, double*,
     std::size_t)
NONE(fmi3ActivateModelPartition, void*, Reference, double)
EXPORT void* fmi3InstantiateModelExchange() { return nullptr; }
EXPORT void* fmi3InstantiateScheduledExecution() { return nullptr; }
