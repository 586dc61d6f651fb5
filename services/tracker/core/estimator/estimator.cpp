// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/estimator/estimator.hpp"

#include "services/tracker/core/estimator/gradient_estimator.hpp"
#include "services/tracker/core/estimator/kalman_estimator.hpp"

namespace pursuit::tracker {
namespace {

std::unique_ptr<Estimator> make_kalman(TransformKind transform, const Contour& contour,
                                       const ObjectParameters& parameters) {
    switch (transform) {
        case TransformKind::isometry:
            return std::make_unique<KalmanEstimator<TransformKind::isometry>>(contour, parameters);
        case TransformKind::similarity:
            return std::make_unique<KalmanEstimator<TransformKind::similarity>>(contour,
                                                                                parameters);
        case TransformKind::paper_affine:
            return std::make_unique<KalmanEstimator<TransformKind::paper_affine>>(contour,
                                                                                  parameters);
        case TransformKind::full_affine:
            break;
    }
    return std::make_unique<KalmanEstimator<TransformKind::full_affine>>(contour, parameters);
}

}  // namespace

std::unique_ptr<Estimator> make_estimator(EstimatorKind kind, TransformKind transform,
                                          const Shape& shape, const ObjectParameters& parameters) {
    const Contour contour(shape);
    if (kind == EstimatorKind::kalman) return make_kalman(transform, contour, parameters);
    return make_gradient(transform, contour, parameters, Pull::point);
}

}  // namespace pursuit::tracker
