// Nodal forces of unit loads that are spread over points on the faces of finite elements.
#pragma once

#include <array>
#include <cmath>

#include "contact/arrays.hpp"

namespace facegear::contact {

// Nodes of the largest face, 3 x 3.
constexpr Index MAX_FACE_NODES = 9;

// Faces of elements on a lattice of nodes; node (i, j) has the number i columns + j.
struct Faces {
    Index rows = 0;           // nodes across the profile
    Index columns = 0;        // nodes along the width
    Table<const Index> steps; // (a, 2) rows and columns from the corner of a face to its nodes
    Index size = 1;           // nodes an element both ways: 1 for bilinear faces, 2 for biquadratic ones

    Index nodes() const { return rows * columns; }
    Index width() const { return steps.rows; }
};

// Lagrange polynomials of an interval with `size` + 1 equidistant nodes, at x in 0..1.
inline std::array<double, 3> interval_functions(double x, Index size) {
    if (size == 1) return {1.0 - x, x, 0.0};
    return {(1.0 - x) * (1.0 - 2.0 * x), 4.0 * x * (1.0 - x), x * (2.0 * x - 1.0)};
}

// A point on a face: the number of the face's first node, and the face's functions there.
struct PointOnFace {
    Index first = -1;
    std::array<double, MAX_FACE_NODES> value{};
};

// Values at refined lattice coordinates; beyond the lattice its outermost faces go on.
inline PointOnFace on_face(const Faces& faces, double row, double column) {
    const std::array<double, 2> at{row, column};
    const std::array<Index, 2> shape{faces.rows, faces.columns};
    std::array<std::array<double, 3>, 2> along;
    std::array<Index, 2> corner;
    const auto size = static_cast<double>(faces.size);
    for (int axis = 0; axis < 2; ++axis) {
        const Index whole = (shape[axis] - 1 - faces.size) / faces.size;
        const auto last = static_cast<double>(whole);
        const double number = std::min(std::max(std::floor(at[axis] / size), 0.0), last);
        corner[axis] = faces.size * static_cast<Index>(number);
        along[axis] = interval_functions((at[axis] - static_cast<double>(corner[axis])) / size, faces.size);
    }
    PointOnFace point;
    point.first = corner[0] * faces.columns + corner[1];
    for (Index a = 0; a < faces.width(); ++a)
        point.value[a] = along[0][faces.steps(a, 0)] * along[1][faces.steps(a, 1)];
    return point;
}

// Sums weights by column: rows over something become rows over what that stands for.
struct RowCollector {
    std::vector<Index> slot; // (columns) where in the list of the current row a column stands

    void begin(Index columns, SparseRowList& out) {
        slot.assign(columns, -1);
        out.clear();
    }
    void add(Index column, double weight, SparseRowList& out) {
        const Index row_start = out.pointer.back();
        if (slot[column] < row_start) {
            slot[column] = static_cast<Index>(out.index.size());
            out.index.push_back(column);
            out.weight.push_back(0.0);
        }
        out.weight[slot[column]] += weight;
    }
};

// Spreads rows over points on the nodes of the faces that the points lie on.
struct NodalSpreading {
    std::vector<PointOnFace> located; // (q)
    RowCollector collector;

    // Rows over the points `at` (q, 2), in refined lattice coordinates, become rows over nodes.
    void spread(SparseRows rows, Table<const double> at, const Faces& faces, SparseRowList& out) {
        located.assign(at.rows, {});
        std::array<Index, MAX_FACE_NODES> offset{};
        for (Index a = 0; a < faces.width(); ++a)
            offset[a] = faces.steps(a, 0) * faces.columns + faces.steps(a, 1);
        collector.begin(faces.nodes(), out);
        for (Index row = 0; row < rows.count(); ++row) {
            const auto points = rows.columns(row);
            const auto weights = rows.weights(row);
            std::array<double, MAX_FACE_NODES> force{};
            for (std::size_t k = 0; k < points.size(); ++k) {
                const PointOnFace& point = locate(points[k], at, faces);
                for (Index a = 0; a < MAX_FACE_NODES; ++a) force[a] += weights[k] * point.value[a];
                // neighbouring points mostly lie on one face: their forces are put on its nodes together
                if (k + 1 < points.size() && locate(points[k + 1], at, faces).first == point.first) continue;
                for (Index a = 0; a < faces.width(); ++a)
                    collector.add(point.first + offset[a], force[a], out);
                force.fill(0.0);
            }
            out.end_row();
        }
    }

    // Rows over what is itself given by `inner` rows over columns become rows over the columns.
    void compose(SparseRows rows, SparseRows inner, Index columns, SparseRowList& out) {
        collector.begin(columns, out);
        for (Index row = 0; row < rows.count(); ++row) {
            const auto middle = rows.columns(row);
            const auto weights = rows.weights(row);
            for (std::size_t k = 0; k < middle.size(); ++k) {
                const auto last = inner.columns(middle[k]);
                const auto factors = inner.weights(middle[k]);
                for (std::size_t m = 0; m < last.size(); ++m)
                    collector.add(last[m], weights[k] * factors[m], out);
            }
            out.end_row();
        }
    }

  private:
    const PointOnFace& locate(Index point, Table<const double> at, const Faces& faces) {
        PointOnFace& place = located[point];
        if (place.first < 0) place = on_face(faces, at(point, 0), at(point, 1));
        return place;
    }
};

} // namespace facegear::contact
