// Cholesky factorisation A = U^T U of small dense matrices, and solutions by it (Golub and Van Loan
// 2013, 4.2).
#pragma once

#include <cmath>

#include "contact/weighted_rows.hpp"

namespace facegear::contact {

// The upper triangle by rows. Each row is as long as whole vectors need; what lies left of the diagonal has
// no meaning.
struct CholeskyFactor {
    OwnedTable upper;
    Index size = 0;

    void resize(Index count) {
        size = count;
        upper.resize(count, (count + LANES - 1) / LANES * LANES);
    }

    // Replace the upper triangle by its factor, four rows at a time; false if it is not positive definite.
    bool factorise() {
        for (Index first = 0; first < size; first += LANES) {
            const Index last = std::min(first + LANES, size);
            for (Index row = first; row < last; ++row) {
                for (Index above = first; above < row; ++above) subtract(row, above);
                if (!(upper(row, row) > 0.0)) return false;
                scale(row, 1.0 / std::sqrt(upper(row, row)));
            }
            if (last - first == LANES) subtract_four(first, last);
        }
        return true;
    }

    // Solve A x = b for two right-hand sides in place.
    void solve(double* first, double* second) {
        for (Index j = 0; j < size; ++j) {
            const double* row = upper.row(j);
            const double a = first[j] /= row[j], b = second[j] /= row[j];
            for (Index i = j + 1; i < size; ++i) {
                first[i] -= row[i] * a;
                second[i] -= row[i] * b;
            }
        }
        for (Index j = size - 1; j >= 0; --j) {
            const double* row = upper.row(j);
            const auto [a, b] = products(row, first, second, j + 1);
            first[j] = (first[j] - a) / row[j];
            second[j] = (second[j] - b) / row[j];
        }
    }

  private:
    // Where the whole vectors begin that hold the diagonal of a row.
    static Index start(Index row) { return row / LANES * LANES; }

    void scale(Index row, double factor) {
        double* values = upper.row(row);
        for (Index i = start(row); i < upper.columns; ++i) values[i] *= factor;
    }

    void subtract(Index row, Index above) {
        double* values = upper.row(row);
        const double* other = upper.row(above);
        const double factor = other[row];
        for (Index i = start(row); i < upper.columns; ++i) values[i] -= factor * other[i];
    }

    // Subtract what four finished rows from `first` on are to the rows from `row` on, two of these at a time.
    void subtract_four(Index first, Index row) {
        for (; row + 2 <= size; row += 2) subtract_from<2>(first, row);
        for (; row < size; ++row) subtract_from<1>(first, row);
    }

    template <int Rows>
    void subtract_from(Index first, Index row) {
        Vector factor[Rows][LANES];
        for (int r = 0; r < Rows; ++r) {
            for (int p = 0; p < LANES; ++p) factor[r][p] = Vector::splat(-upper(first + p, row + r));
        }
        const double* above[LANES] = {upper.row(first), upper.row(first + 1), upper.row(first + 2),
                                      upper.row(first + 3)};
        double* values = upper.row(row);
        for (Index i = start(row); i < upper.columns; i += LANES) {
            const Vector a = Vector::load(above[0] + i), b = Vector::load(above[1] + i);
            const Vector c = Vector::load(above[2] + i), d = Vector::load(above[3] + i);
            for (int r = 0; r < Rows; ++r) {
                double* to = values + r * upper.columns + i;
                Vector sum = multiply_add(factor[r][0], a, Vector::load(to));
                sum = multiply_add(factor[r][1], b, sum);
                sum = multiply_add(factor[r][2], c, sum);
                multiply_add(factor[r][3], d, sum).store(to);
            }
        }
    }

    struct Products {
        double first, second;
    };

    Products products(const double* row, const double* first, const double* second, Index begin) const {
        Vector a = Vector::splat(0.0), b = a;
        Index i = begin;
        for (; i + LANES <= size; i += LANES) {
            const Vector values = Vector::load(row + i);
            a = multiply_add(values, Vector::load(first + i), a);
            b = multiply_add(values, Vector::load(second + i), b);
        }
        Products sum{(a[0] + a[1]) + (a[2] + a[3]), (b[0] + b[1]) + (b[2] + b[3])};
        for (; i < size; ++i) {
            sum.first += row[i] * first[i];
            sum.second += row[i] * second[i];
        }
        return sum;
    }
};

} // namespace facegear::contact
