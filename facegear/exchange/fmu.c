/* Dynamic model of a facegear machine as an FMU for co-simulation (FMI 3.0).

   y'' + damping y' + omega2 y + G^T F = load,  F = k(s) x + c d',  d = G y - e(s),  s = phase of the mesh cycle,
   x = d - upper above `upper`, d - lower below `lower`, zero between.  model.h holds the numbers.
   Integrated by the pair of orders 5 and 4 of Dormand and Prince (1980) with steps of its own. */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "model.h"

#if defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

typedef enum { OK, WARNING, DISCARD, ERROR, FATAL } Status;
typedef uint32_t Reference;

#define TAU 6.283185307179586476925286766559
#define STATES (2 * COORDINATES)
#define INPUTS (1 + BODIES)
#define FIRST_OUTPUT (1 + INPUTS)
#define OUTPUTS (2 * CONTACTS + 3 * BODIES)
#define MIN_STEP 1e-14 /* s */

typedef struct {
    double time, phase, step;
    double input[INPUTS]; /* speed (rpm), torques (N m) */
    double state[STATES]; /* coordinates, then velocities */
} Instance;

/* Series at the phase of a mesh cycle (rad), and its derivative by the phase. */
static double series(const double *sine, const double *cosine, int terms, double phase, double *slope) {
    double value = 0.0, derivative = 0.0;
    for (int j = 0; j < terms; j++) {
        double s = sin(j * phase), c = cos(j * phase);
        value += sine[j] * s + cosine[j] * c;
        derivative += j * (sine[j] * c - cosine[j] * s);
    }
    if (slope) *slope = derivative;
    return value;
}

/* Deflection of a contact (m), its elastic force (N), and the force with its damper. */
static double contact(const Instance *at, const double *state, double phase, double rate, int m, double *deflection,
                      double *elastic) {
    double slope, d = 0.0, velocity = 0.0, pressed = 0.0;
    for (int i = 0; i < COORDINATES; i++) {
        d += jacobian[m][i] * state[i];
        velocity += jacobian[m][i] * state[COORDINATES + i];
    }
    (void)at;
    d -= series(error_sine[m], error_cosine[m], ERROR_TERMS, phase, &slope);
    velocity -= slope * rate;
    if (lower[m] >= upper[m] || d > upper[m]) pressed = d - upper[m];
    else if (d < lower[m]) pressed = d - lower[m];
    bool closed = pressed != 0.0;
    double spring = pressed * series(stiffness_sine[m], stiffness_cosine[m], STIFFNESS_TERMS, phase, NULL);
    double force = spring + (closed || DAMPING_WHEN_OPEN ? mesh_damping[m] * velocity : 0.0);
    if (PUSH_ONLY && pressed >= 0.0 && force < 0.0) force = 0.0;
    if (PUSH_ONLY && pressed < 0.0 && force > 0.0) force = 0.0;
    if (deflection) *deflection = d;
    if (elastic) *elastic = spring;
    return force;
}

static double mesh_rate(const Instance *at) { return TAU * PINION_TEETH * at->input[0] / 60.0; }

static void slope_of(const Instance *at, double phase, const double *state, double *slope) {
    double rate = mesh_rate(at);
    for (int i = 0; i < COORDINATES; i++) {
        double force = load[i] - damping[i] * state[COORDINATES + i] - omega_squared[i] * state[i];
        for (int b = 0; b < BODIES; b++) force += load_of_torque[i][b] * at->input[1 + b];
        slope[i] = state[COORDINATES + i];
        slope[COORDINATES + i] = force;
    }
    for (int m = 0; m < CONTACTS; m++) {
        double force = contact(at, state, phase, rate, m, NULL, NULL);
        for (int i = 0; i < COORDINATES; i++) slope[COORDINATES + i] -= jacobian[m][i] * force;
    }
}

static const double NODE[7] = {0.0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1.0, 1.0};
static const double WEIGHT[7][6] = {
    {0},
    {1.0 / 5},
    {3.0 / 40, 9.0 / 40},
    {44.0 / 45, -56.0 / 15, 32.0 / 9},
    {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
    {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
    {35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
static const double LESS[7] = {71.0 / 57600,      0.0,          -71.0 / 16695, 71.0 / 1920,
                               -17253.0 / 339200, 22.0 / 525, -1.0 / 40};

/* One step tried from the state; returns the error over the tolerance, the new state in `next`. */
static double attempt(const Instance *at, double h, double *next) {
    double slopes[7][STATES], worst = 0.0, rate = mesh_rate(at);
    for (int stage = 0; stage < 7; stage++) {
        for (int i = 0; i < STATES; i++) {
            double sum = 0.0;
            for (int j = 0; j < stage; j++) sum += WEIGHT[stage][j] * slopes[j][i];
            next[i] = at->state[i] + h * sum;
        }
        slope_of(at, at->phase + rate * NODE[stage] * h, next, slopes[stage]);
    }
    for (int i = 0; i < STATES; i++) {
        double error = 0.0;
        for (int stage = 0; stage < 7; stage++) error += LESS[stage] * slopes[stage][i];
        double size = i < COORDINATES ? COORDINATE_SCALE : COORDINATE_SCALE * RATE_SCALE;
        worst = fmax(worst, fabs(h * error) / (TOLERANCE * size));
    }
    return isfinite(worst) ? worst : 1e9;
}

static Status advance(Instance *at, double end) {
    double next[STATES];
    while (end - at->time > MIN_STEP) {
        double left = end - at->time, h = at->step < left ? at->step : left;
        double error = attempt(at, h, next);
        if (error <= 1.0) {
            memcpy(at->state, next, sizeof next);
            at->time = h == left ? end : at->time + h;
            at->phase = fmod(at->phase + mesh_rate(at) * h, TAU);
        } else if (h <= MIN_STEP) {
            return ERROR;
        }
        double factor = 0.9 * pow(fmax(error, 1e-10), -0.2);
        h *= factor < 0.2 ? 0.2 : factor > 4.0 ? 4.0 : factor;
        if (error > 1.0 || h > at->step || left > at->step) at->step = h;
    }
    at->time = end;
    return OK;
}

static double output(const Instance *at, int number) {
    double deflection, elastic, force = 0.0;
    if (number < 2 * CONTACTS) {
        contact(at, at->state, at->phase, mesh_rate(at), number % CONTACTS, &deflection, &elastic);
        return number < CONTACTS ? deflection : elastic;
    }
    for (int i = 0; i < COORDINATES; i++)
        force += bearing_stiffness[number - 2 * CONTACTS][i] * at->state[i] +
                 bearing_damping[number - 2 * CONTACTS][i] * at->state[COORDINATES + i];
    return force;
}

static void begin(Instance *at) {
    memset(at, 0, sizeof *at);
    memcpy(at->input, start_input, sizeof start_input);
    memcpy(at->state, start_coordinates, sizeof start_coordinates);
    at->step = 1e-7;
}

EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

EXPORT void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *path, bool visible, bool log,
                                         bool events, bool early, const Reference *required, size_t count,
                                         void *environment, void *message, void *update) {
    (void)name, (void)path, (void)visible, (void)log, (void)events, (void)early, (void)required, (void)count;
    (void)environment, (void)message, (void)update;
    if (!token || strcmp(token, TOKEN)) return NULL;
    Instance *at = malloc(sizeof *at);
    if (at) begin(at);
    return at;
}

EXPORT void fmi3FreeInstance(void *instance) { free(instance); }

EXPORT Status fmi3Reset(void *instance) {
    begin(instance);
    return OK;
}

EXPORT Status fmi3EnterInitializationMode(void *instance, bool defined, double tolerance, double start, bool stops,
                                          double stop) {
    (void)defined, (void)tolerance, (void)stops, (void)stop;
    ((Instance *)instance)->time = start;
    return OK;
}

EXPORT Status fmi3SetFloat64(void *instance, const Reference *references, size_t count, const double *values,
                             size_t number) {
    Instance *at = instance;
    if (count != number) return ERROR;
    for (size_t i = 0; i < count; i++) {
        if (references[i] < 1 || references[i] > INPUTS || !isfinite(values[i])) return ERROR;
        at->input[references[i] - 1] = values[i];
    }
    return OK;
}

EXPORT Status fmi3GetFloat64(void *instance, const Reference *references, size_t count, double *values, size_t number) {
    const Instance *at = instance;
    if (count != number) return ERROR;
    for (size_t i = 0; i < count; i++) {
        Reference asked = references[i];
        if (asked >= FIRST_OUTPUT + OUTPUTS) return ERROR;
        values[i] = asked == 0 ? at->time
                    : asked < FIRST_OUTPUT ? at->input[asked - 1]
                                           : output(at, (int)(asked - FIRST_OUTPUT));
    }
    return OK;
}

EXPORT Status fmi3DoStep(void *instance, double time, double step, bool unused, bool *event, bool *terminate,
                         bool *early, double *last) {
    Instance *at = instance;
    (void)unused;
    *event = *terminate = *early = false;
    *last = at->time;
    if (!(step > 0.0) || !isfinite(time + step) || time + step <= at->time) return ERROR;
    Status status = advance(at, time + step);
    *last = at->time;
    return status;
}

/* What this model does without, in two groups: nothing to do, and nothing to give. */
#define DONE(name, ...) EXPORT Status name(__VA_ARGS__) { return OK; }
#define NONE(name, ...) EXPORT Status name(__VA_ARGS__) { return ERROR; }
DONE(fmi3SetDebugLogging, void *a, bool b, size_t c, const char *const *d)
DONE(fmi3ExitInitializationMode, void *a)
DONE(fmi3EnterStepMode, void *a)
DONE(fmi3EnterEventMode, void *a)
DONE(fmi3EnterConfigurationMode, void *a)
DONE(fmi3ExitConfigurationMode, void *a)
DONE(fmi3Terminate, void *a)
#define OTHER(type, name) \
    NONE(fmi3Get##name, void *a, const Reference *b, size_t c, type *d, size_t e) \
    NONE(fmi3Set##name, void *a, const Reference *b, size_t c, const type *d, size_t e)
OTHER(float, Float32)
OTHER(int8_t, Int8)
OTHER(uint8_t, UInt8)
OTHER(int16_t, Int16)
OTHER(uint16_t, UInt16)
OTHER(int32_t, Int32)
OTHER(uint32_t, UInt32)
OTHER(int64_t, Int64)
OTHER(uint64_t, UInt64)
OTHER(bool, Boolean)
OTHER(char *, String)
NONE(fmi3GetBinary, void *a, const Reference *b, size_t c, size_t *d, const uint8_t **e, size_t f)
NONE(fmi3SetBinary, void *a, const Reference *b, size_t c, const size_t *d, const uint8_t *const *e, size_t f)
NONE(fmi3GetClock, void *a, const Reference *b, size_t c, bool *d)
NONE(fmi3SetClock, void *a, const Reference *b, size_t c, const bool *d)
NONE(fmi3GetNumberOfVariableDependencies, void *a, Reference b, size_t *c)
NONE(fmi3GetVariableDependencies, void *a, Reference b, size_t *c, Reference *d, size_t *e, int *f, size_t g)
NONE(fmi3GetFMUState, void *a, void **b)
NONE(fmi3SetFMUState, void *a, void *b)
NONE(fmi3FreeFMUState, void *a, void **b)
NONE(fmi3SerializedFMUStateSize, void *a, void *b, size_t *c)
NONE(fmi3SerializeFMUState, void *a, void *b, uint8_t *c, size_t d)
NONE(fmi3DeserializeFMUState, void *a, const uint8_t *b, size_t c, void **d)
NONE(fmi3GetDirectionalDerivative, void *a, const Reference *b, size_t c, const Reference *d, size_t e, const double *f, size_t g, double *h, size_t i)
NONE(fmi3GetAdjointDerivative, void *a, const Reference *b, size_t c, const Reference *d, size_t e, const double *f, size_t g, double *h, size_t i)
NONE(fmi3GetIntervalDecimal, void *a, const Reference *b, size_t c, double *d, int *e)
NONE(fmi3GetIntervalFraction, void *a, const Reference *b, size_t c, uint64_t *d, uint64_t *e, int *f)
NONE(fmi3GetShiftDecimal, void *a, const Reference *b, size_t c, double *d)
NONE(fmi3GetShiftFraction, void *a, const Reference *b, size_t c, uint64_t *d, uint64_t *e)
NONE(fmi3SetIntervalDecimal, void *a, const Reference *b, size_t c, const double *d)
NONE(fmi3SetIntervalFraction, void *a, const Reference *b, size_t c, const uint64_t *d, const uint64_t *e)
NONE(fmi3SetShiftDecimal, void *a, const Reference *b, size_t c, const double *d)
NONE(fmi3SetShiftFraction, void *a, const Reference *b, size_t c, const uint64_t *d, const uint64_t *e)
NONE(fmi3EvaluateDiscreteStates, void *a)
NONE(fmi3UpdateDiscreteStates, void *a, bool *b, bool *c, bool *d, bool *e, bool *f, double *g)
NONE(fmi3EnterContinuousTimeMode, void *a)
NONE(fmi3CompletedIntegratorStep, void *a, bool b, bool *c, bool *d)
NONE(fmi3SetTime, void *a, double b)
NONE(fmi3SetContinuousStates, void *a, const double *b, size_t c)
NONE(fmi3GetContinuousStateDerivatives, void *a, double *b, size_t c)
NONE(fmi3GetEventIndicators, void *a, double *b, size_t c)
NONE(fmi3GetContinuousStates, void *a, double *b, size_t c)
NONE(fmi3GetNominalsOfContinuousStates, void *a, double *b, size_t c)
NONE(fmi3GetNumberOfEventIndicators, void *a, size_t *b)
NONE(fmi3GetNumberOfContinuousStates, void *a, size_t *b)
NONE(fmi3GetOutputDerivatives, void *a, const Reference *b, size_t c, const int32_t *d, double *e, size_t f)
NONE(fmi3ActivateModelPartition, void *a, Reference b, double c)
EXPORT void *fmi3InstantiateModelExchange(void) { return NULL; }
EXPORT void *fmi3InstantiateScheduledExecution(void) { return NULL; }
