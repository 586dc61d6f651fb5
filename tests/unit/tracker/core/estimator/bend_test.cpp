// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/estimator/bend.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <random>

#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker {
namespace {

using test::arrow;

/// An arrow's contour, and a pixel's distances to a plane that shows it in perspective.
class Bending : public testing::Test {
 protected:
    Eigen::Vector2d seen(const Eigen::Vector2d& m) const { return m / (1 + slant_.dot(m)); }

    /// The affine map nearest to the view at the model's points, brute force: rows 1, mₓ, m_y.
    Eigen::Matrix<double, 3, 2> best_fit() const {
        const auto count = static_cast<Eigen::Index>(shape_.points_px.size());
        Eigen::MatrixXd model(count, 3);
        Eigen::MatrixXd view(count, 2);
        for (Eigen::Index i = 0; i < count; ++i) {
            const Eigen::Vector2d m = point(static_cast<std::size_t>(i));
            model.row(i) << 1, m.x(), m.y();
            view.row(i) = seen(m).transpose();
        }
        return model.colPivHouseholderQr().solve(view);
    }
    Eigen::Vector2d point(std::size_t i) const { return shape_.points_px[i].cast<double>(); }

    /// `events` residuals along random normals, of a view that departs by departure(m).
    template <class Departure>
    void learn(Departure departure, double noise_px, int events) {
        std::mt19937 random(7);
        std::normal_distribution<double> noise(0, noise_px);
        for (int i = 0; i < events; ++i) {
            const Eigen::Vector2d m = point(random() % shape_.points_px.size());
            const double angle = 0.01 * static_cast<double>(random() % 628);
            const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
            const double r_px =
                n.dot(departure(m) - (bend_.is_flat() ? Eigen::Vector2d(0, 0) : bend_.shift(m)));
            bend_.predict(0.01);
            bend_.correct(bend_.along(n, m), r_px + noise(random), 0.16, 1);
        }
    }

    const Shape shape_ = arrow();
    const Eigen::Vector2d slant_{0.0015, -0.001};
    Bend bend_{Contour(shape_)};
};

TEST_F(Bending, has_no_affine_part_at_the_models_points) {
    for (const Eigen::Vector2d& g : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0.3, -2)}) {
        Eigen::Matrix<double, 2, 3> sum = Eigen::Matrix<double, 2, 3>::Zero();
        double size = 0;
        for (std::size_t i = 0; i < shape_.points_px.size(); ++i) {
            const Eigen::Vector2d m = point(i);
            const Eigen::Vector2d along = bend_.along(g, m);
            sum += along * Eigen::RowVector3d(1, m.x(), m.y());
            size += along.norm() * m.norm();
        }
        EXPECT_LT(sum.cwiseAbs().maxCoeff(), 1e-4 * size) << sum;
    }
}

TEST_F(Bending, is_learnt_from_a_view_in_perspective_as_what_its_best_affine_fit_leaves) {
    const auto fit = best_fit();
    const auto left = [&](const Eigen::Vector2d& m) {
        return Eigen::Vector2d(seen(m) - (Eigen::RowVector3d(1, m.x(), m.y()) * fit).transpose());
    };
    learn(left, 0.3, 4000);
    ASSERT_FALSE(bend_.is_flat());
    double off2 = 0;
    double all2 = 0;
    for (std::size_t i = 0; i < shape_.points_px.size(); ++i) {
        off2 += (bend_.shift(point(i)) - left(point(i))).squaredNorm();
        all2 += left(point(i)).squaredNorm();
    }
    EXPECT_LT(off2, 0.15 * 0.15 * all2);
}

TEST_F(Bending, is_flat_before_any_event_and_where_only_noise_speaks_for_it) {
    bend_.restart();
    EXPECT_TRUE(bend_.is_flat());
    learn([](const Eigen::Vector2d&) { return Eigen::Vector2d(0, 0); }, 0.4, 20'000);
    EXPECT_TRUE(bend_.is_flat());
    EXPECT_EQ(bend_.shift({20, 5}), Eigen::Vector2d(0, 0));
}

TEST_F(Bending, is_flat_again_after_a_restart) {
    learn([&](const Eigen::Vector2d& m) { return Eigen::Vector2d(seen(m) - m); }, 0, 2000);
    ASSERT_FALSE(bend_.is_flat());
    bend_.restart();
    EXPECT_TRUE(bend_.is_flat());
    EXPECT_EQ(bend_.shift({20, 5}), Eigen::Vector2d(0, 0));
}

TEST_F(Bending, stays_bounded_whatever_the_residuals) {
    for (int i = 0; i < 1000; ++i) {
        bend_.predict(10);
        bend_.correct(bend_.along({1, 0}, {30, 10}), 1e6, 0.16, 1);
    }
    EXPECT_LT(bend_.shift({30, 10}).norm(), 30);
}

TEST_F(Bending, of_points_on_a_line_is_finite) {
    const Shape line{"line", {{-10, 0}, {-2, 0}, {12, 0}}, {{0, 1}, {1, 2}}};
    Bend bend{Contour(line)};
    bend.restart();
    for (int i = 0; i < 1000; ++i) {
        bend.predict(0.1);
        bend.correct(bend.along({1, 0}, {12, 0}), 1, 0.16, 1);
    }
    EXPECT_TRUE(bend.shift({12, 3}).allFinite());
}

}  // namespace
}  // namespace pursuit::tracker
