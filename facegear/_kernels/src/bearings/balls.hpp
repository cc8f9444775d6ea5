// Ball bearings in five motions (de Mul et al. 1989): Hertzian contacts between groove centres.
//
// A contact is stretched where both centres are further apart than at rest: Q = c delta^1.5 along the line
// between them. The energy is convex in the motion of the ring, since rotations are taken to first order.
#pragma once

#include <cmath>

#include "bearings/position.hpp"
#include "bearings/ring.hpp"
#include "tables.hpp"

namespace facegear::bearings {

// A bearing of Z balls; lengths in m, stiffness in N/m^1.5.
struct Balls {
    List<const double> cosine, sine;                    // (Z,) of the angle of each ball, from x towards y
    double arm, height;                                 // radius and z of the inner groove's centre
    double rest_radial, rest_axial;                     // from the outer to the inner groove's centre at rest
    double inner_length, outer_length;                  // from a groove's centre to the ball's at first touch
    double inner_stiffness, outer_stiffness, stiffness; // of single contacts, and of both in series
    double centrifugal;                                 // force on each ball, N
    double free_energy;                                 // of a ball on the outer ring alone, J

    Rows rows(Index ball) const {
        const double c = cosine[ball], s = sine[ball];
        return {{c, s, 0.0, -height * s, height * c}, {0.0, 0.0, 1.0, arm * s, -arm * c}};
    }
    // Radial and axial position of the inner groove's centre from the outer one's.
    Position centre(const Rows& rows, const double* motion) const {
        return {rest_radial + rows.first_of(motion), rest_axial + rows.second_of(motion)};
    }
};

// A contact whose centres are `vector` apart: first is radial, second axial.
inline Derivatives stretch(Position vector, double length, double stiffness) {
    const double distance = std::sqrt(vector.first * vector.first + vector.second * vector.second);
    const double approach = distance - length;
    if (approach <= 0.0) return {};
    const double root = std::sqrt(approach), load = stiffness * approach * root;
    const double radial = vector.first / distance, axial = vector.second / distance;
    const double along = 1.5 * stiffness * root, across = load / distance;
    return {0.4 * load * approach,
            load * radial,
            load * axial,
            along * radial * radial + across * axial * axial,
            (along - across) * radial * axial,
            along * axial * axial + across * radial * radial};
}

// A ball between both grooves under centrifugal force, by its position from the outer groove's centre.
struct ThrownBall {
    const Balls& bearing;
    Position centre;

    Derivatives inner(Position ball) const {
        const Position vector{centre.first - ball.first, centre.second - ball.second};
        return stretch(vector, bearing.inner_length, bearing.inner_stiffness);
    }
    Derivatives outer(Position ball) const {
        return stretch(ball, bearing.outer_length, bearing.outer_stiffness);
    }
    Derivatives at(Position ball) const {
        const Derivatives i = inner(ball), e = outer(ball);
        return {i.energy + e.energy - bearing.centrifugal * ball.first,
                e.first - i.first - bearing.centrifugal,
                e.second - i.second,
                i.first_first + e.first_first,
                i.first_second + e.first_second,
                i.second_second + e.second_second};
    }
    static double arm() { return 1.0; }
    // Of the outer contact across its normal, under the centrifugal force alone.
    double softest() const { return bearing.centrifugal / bearing.outer_length; }
    static double size(Position ball) { return std::fabs(ball.first) + std::fabs(ball.second); }
    // On the line between both centres, as without the force; outside the inner contact where that is open.
    Position start() const {
        const double distance = std::sqrt(centre.first * centre.first + centre.second * centre.second);
        const double approach = distance - bearing.inner_length - bearing.outer_length;
        if (!(approach > 0.0)) return top();
        const double part = std::pow(bearing.stiffness / bearing.outer_stiffness, 2.0 / 3.0);
        const double length = (bearing.outer_length + part * approach) / distance;
        return {length * centre.first, length * centre.second};
    }
    // Where the force alone holds the ball: the top of the outer groove.
    Position top() const {
        return {bearing.outer_length + std::pow(bearing.centrifugal / bearing.outer_stiffness, 2.0 / 3.0),
                0.0};
    }
};

// Loads (N) and angles (rad) of both contacts of a ball.
struct BallContacts {
    double inner, outer, inner_angle, outer_angle;
};

inline double size_of(const Derivatives& contact) {
    return std::sqrt(contact.first * contact.first + contact.second * contact.second);
}

// Derivatives of a ball's energy by the inner groove's centre, and its contacts; false where the ball finds
// no position.
inline bool respond(const Balls& bearing, Position centre, Derivatives& result, BallContacts& contacts) {
    if (bearing.centrifugal == 0.0) {
        result = stretch(centre, bearing.inner_length + bearing.outer_length, bearing.stiffness);
        const double load = size_of(result), angle = std::atan2(centre.second, centre.first);
        contacts = {load, load, angle, angle};
        return true;
    }
    const ThrownBall thrown{bearing, centre};
    Position ball = thrown.top();
    bool is_found = true;
    if (thrown.inner(ball).energy != 0.0) {
        ball = thrown.start();
        is_found = settle(thrown, ball);
    }
    const Derivatives inner = thrown.inner(ball), outer = thrown.outer(ball);
    result = inner;
    result.energy = inner.energy + outer.energy - bearing.centrifugal * ball.first - bearing.free_energy;
    put_in_series(inner, outer, result);
    contacts = {size_of(inner), size_of(outer),
                std::atan2(centre.second - ball.second, centre.first - ball.first),
                std::atan2(ball.second, ball.first)};
    return is_found;
}

// Adds all balls at a motion (5,); returns how many of them found no position.
inline Index respond(const Balls& bearing, const double* motion, Response& response) {
    Index lost = 0;
    for (Index ball = 0; ball < bearing.cosine.size; ++ball) {
        const Rows rows = bearing.rows(ball);
        Derivatives element;
        BallContacts contacts;
        lost += !respond(bearing, bearing.centre(rows, motion), element, contacts);
        rows.add(element, response);
    }
    return lost;
}

// Writes loads and angles (Z, 4) of all balls at a motion; returns how many found no position.
inline Index write_loads(const Balls& bearing, const double* motion, double* loads) {
    Index lost = 0;
    for (Index ball = 0; ball < bearing.cosine.size; ++ball) {
        Derivatives element;
        BallContacts contacts;
        lost += !respond(bearing, bearing.centre(bearing.rows(ball), motion), element, contacts);
        double* row = loads + 4 * ball;
        row[0] = contacts.inner;
        row[1] = contacts.outer;
        row[2] = contacts.inner_angle;
        row[3] = contacts.outer_angle;
    }
    return lost;
}

} // namespace facegear::bearings
