#include "pipeline/analysis/residual_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "pipeline/analysis/median.hpp"
#include "pipeline/analysis/noise_memory.hpp"

namespace kinectlab {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Residuals = std::vector<Vector3d>;
using Jacobians = std::vector<Jacobian3>;

constexpr int kMostSteps = 60;
constexpr double kMedianChi2[] = {0.455, 1.386, 2.366};  // of one to three degrees of freedom
constexpr double kSmallestNoise = 1e-6;  // share of the given variance below which it is rounding
constexpr double kDifference = 1e-4;     // of a parameter's scale
constexpr double kFewestIndependent = 4.0;  // of one direction, to know the size of its noise by
constexpr double kNothingKnown = 1e-6;  // 1/scale: keeps a parameter that nothing shows in place

struct Equations {
    MatrixXd information;
    VectorXd gradient;
};

class Fitter {
public:
    Fitter(
        std::span<const ResidualPlace> places,
        const ResidualModel& model,
        std::span<const PathParameter> parameters
    )
        : places_(places), model_(model), n_(static_cast<Index>(parameters.size())) {
        at_ = VectorXd(n_);
        scale_ = VectorXd(n_);
        prior_ = VectorXd(n_);
        prior_information_ = VectorXd::Zero(n_);
        for (Index i = 0; i < n_; ++i) {
            const PathParameter& p = parameters[static_cast<std::size_t>(i)];
            const bool fixed = p.prior_u == 0.0;
            at_[i] = fixed ? p.prior : p.start;
            scale_[i] = p.scale;
            prior_[i] = p.prior_u > 0.0 ? p.prior : at_[i];
            prior_information_[i] = p.prior_u > 0.0 ? 1.0 / (p.prior_u * p.prior_u)
                                                    : std::pow(kNothingKnown / p.scale, 2);
            if (!fixed) free_.push_back(i);
        }
        for (const auto& place : places)
            series_ = std::max(series_, place.series + 1);
        rescale_.assign(static_cast<std::size_t>(series_), Matrix3d::Identity());
        use_.assign(places.size(), true);
    }

    Result<ResidualFit> run(const ResidualFitSettings& settings) {
        if (3 * places_.size() <= free_.size() + 3)
            return fail(
                ErrorCode::bad_data,
                "samples",
                "there are " + std::to_string(places_.size()),
                "measure for longer, or see that the object stays in the picture"
            );
        if (!std::isfinite(cost(at_)))
            return fail(ErrorCode::bad_data, "samples", "no motion starts from the first guess");
        huber_ = 3.0;
        for (int i = 0; i < 2; ++i) {
            rescale_by_median();
            minimise();
        }
        huber_ = std::numeric_limits<double>::infinity();
        rescale_by_median();
        for (int round = 0; round < 4; ++round) {
            std::vector<bool> use(places_.size(), true);
            const Residuals r = residuals(at_);
            std::size_t kept = 0;
            for (std::size_t i = 0; i < r.size(); ++i) {
                use[i] = whitened(i, r).norm() <= settings.outlier_sigma;
                kept += use[i] ? 1 : 0;
            }
            if (3 * kept <= free_.size() + 3) break;
            const bool settled = round > 1 && use == use_;
            use_ = std::move(use);
            if (settled) break;
            whiten(r);
            minimise();
            whiten(residuals(at_));
        }
        return summary(settings);
    }

private:
    [[nodiscard]] Residuals residuals(const VectorXd& at) const {
        Residuals r(places_.size());
        model_(at, r);
        return r;
    }

    [[nodiscard]] const Matrix3d& rescale(std::size_t i) const {
        return rescale_[static_cast<std::size_t>(places_[i].series)];
    }

    [[nodiscard]] Vector3d whitened(std::size_t i, const Residuals& r) const {
        return rescale(i) * r[i];
    }

    [[nodiscard]] double cost(const VectorXd& at) const {
        const Residuals r = residuals(at);
        double sum = 0.0;
        for (std::size_t i = 0; i < r.size(); ++i) {
            if (!use_[i]) continue;
            const double d = whitened(i, r).norm();
            sum += d > huber_ ? huber_ * (d - huber_ / 2) : d * d / 2;
        }
        sum += 0.5 * (prior_ - at).cwiseAbs2().dot(prior_information_);
        return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
    }

    /// Of the fit, whitened, over the free parameters.
    [[nodiscard]] Jacobians jacobians() const {
        Jacobians j(places_.size(), Jacobian3::Zero(3, static_cast<Index>(free_.size())));
        Residuals high(places_.size());
        Residuals low(places_.size());
        for (std::size_t k = 0; k < free_.size(); ++k) {
            const Index i = free_[k];
            VectorXd moved = at_;
            const double step = kDifference * scale_[i];
            moved[i] = at_[i] + step;
            model_(moved, high);
            moved[i] = at_[i] - step;
            model_(moved, low);
            for (std::size_t s = 0; s < places_.size(); ++s)
                j[s].col(static_cast<Index>(k)) = rescale(s) * (low[s] - high[s]) / (2.0 * step);
        }
        return j;
    }

    [[nodiscard]] Equations normal_equations() const {
        const auto n = static_cast<Index>(free_.size());
        const Residuals r = residuals(at_);
        const Jacobians j = jacobians();
        Equations sum{MatrixXd::Zero(n, n), VectorXd::Zero(n)};
        for (std::size_t s = 0; s < places_.size(); ++s) {
            if (!use_[s]) continue;
            const Vector3d w = whitened(s, r);
            const double d = w.norm();
            const double weight = d > huber_ ? huber_ / d : 1.0;
            sum.information.noalias() += weight * j[s].transpose() * j[s];
            sum.gradient.noalias() += weight * j[s].transpose() * w;
        }
        const VectorXd prior = free(prior_information_);
        sum.information.diagonal() += prior;
        sum.gradient += prior.cwiseProduct(free(prior_ - at_));
        return sum;
    }

    void minimise() {
        double lambda = 1e-3;
        double here = cost(at_);
        for (int step = 0; step < kMostSteps; ++step) {
            const auto [information, pull] = normal_equations();
            bool better = false;
            double predicted = 0.0;
            while (lambda < 1e12) {
                MatrixXd damped = information;
                damped.diagonal() *= 1.0 + lambda;
                const VectorXd change = inverse(damped) * pull;
                predicted = change.dot(pull);
                VectorXd trial = at_;
                for (std::size_t k = 0; k < free_.size(); ++k)
                    trial[free_[k]] += change[static_cast<Index>(k)];
                const double there = cost(trial);
                better = there <= here;
                if (better) {
                    at_ = trial;
                    here = there;
                    lambda = std::max(lambda / 10.0, 1e-12);
                    break;
                }
                if (predicted < 1e-9 * (1.0 + here)) break;
                lambda *= 10.0;
            }
            if (!better || predicted < 1e-6) break;
        }
    }

    void rescale_by_median() {
        const Residuals r = residuals(at_);
        for (int one = 0; one < series_; ++one) {
            std::vector<double> d;
            for (std::size_t i = 0; i < r.size(); ++i)
                if (places_[i].series == one) d.push_back(r[i].norm());
            if (d.empty()) continue;
            const double factor = median(std::move(d)) / std::sqrt(kMedianChi2[2]);
            rescale_[static_cast<std::size_t>(one)] =
                Matrix3d::Identity() / std::max(factor, std::sqrt(kSmallestNoise));
        }
    }

    /// Makes each thing's used residuals white on average; a direction without any is left out.
    void whiten(const Residuals& r) {
        const auto used = static_cast<double>(std::count(use_.begin(), use_.end(), true));
        directions_ = 0;
        for (int one = 0; one < series_; ++one) {
            Matrix3d s = Matrix3d::Zero();
            double n = 0.0;
            for (std::size_t i = 0; i < r.size(); ++i) {
                if (!use_[i] || places_[i].series != one) continue;
                s += r[i] * r[i].transpose();
                n += 1.0;
            }
            if (n == 0.0) continue;
            n *= 1.0 - static_cast<double>(free_.size()) / (3.0 * used);
            const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(s / n);
            const auto alive = [&](double value) {
                return value > kSmallestNoise * std::max(1.0, eigen.eigenvalues()[2]);
            };
            Vector3d root = Vector3d::Zero();
            int directions = 0;
            for (int k = 0; k < 3; ++k)
                if (alive(eigen.eigenvalues()[k])) {
                    root[k] = 1.0 / std::sqrt(eigen.eigenvalues()[k]);
                    ++directions;
                }
            if (directions == 0) {  // noiseless in every direction
                root.setConstant(1.0 / std::sqrt(kSmallestNoise));
                directions = 3;
            }
            const Matrix3d whiten =
                eigen.eigenvectors() * root.asDiagonal() * eigen.eigenvectors().transpose();
            std::vector<double> d;
            for (std::size_t i = 0; i < r.size(); ++i)
                if (places_[i].series == one) d.push_back((whiten * r[i]).norm());
            const double typical = median(std::move(d)) / std::sqrt(kMedianChi2[directions - 1]);
            rescale_[static_cast<std::size_t>(one)] = whiten / std::max(typical, 1.0);
            directions_ = std::max(directions_, directions);
        }
    }

    [[nodiscard]] VectorXd free(const VectorXd& all) const {
        VectorXd some(static_cast<Index>(free_.size()));
        for (std::size_t k = 0; k < free_.size(); ++k)
            some[static_cast<Index>(k)] = all[free_[k]];
        return some;
    }

    [[nodiscard]] static MatrixXd inverse(const MatrixXd& m) {
        const VectorXd scale = m.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
        const MatrixXd scaled = scale.asDiagonal() * m * scale.asDiagonal();
        return scale.asDiagonal() * scaled.ldlt().solve(MatrixXd::Identity(m.rows(), m.cols())) *
               scale.asDiagonal();
    }

    [[nodiscard]] std::vector<FitSeries> left_over(const Residuals& r) const {
        const Jacobians j = jacobians();
        std::vector<FitSeries> series(static_cast<std::size_t>(series_));
        for (std::size_t i = 0; i < places_.size(); ++i) {
            if (!use_[i]) continue;
            FitSeries& one = series[static_cast<std::size_t>(places_[i].series)];
            one.t.push_back(places_[i].t);
            one.residual.push_back(whitened(i, r));
            one.jacobian.push_back(j[i]);
        }
        return series;
    }

    [[nodiscard]] ResidualFit summary(const ResidualFitSettings& settings) const {
        ResidualFit fit;
        fit.parameters = at_;
        fit.residuals = residuals(at_);
        fit.used = use_;
        const auto series = left_over(fit.residuals);
        const VectorXd prior = free(prior_information_);
        const MatrixXd c = inverse(normal_equations().information);

        std::vector<double> steps;
        int used = 0;
        for (const FitSeries& one : series) {
            used += static_cast<int>(one.t.size());
            for (std::size_t i = 1; i < one.t.size(); ++i)
                steps.push_back(one.t[i] - one.t[i - 1]);
        }
        const double step = median(std::move(steps));
        NoiseMemories noise(step, settings.longest_memory_s, directions_);
        noise.add(series, prior);
        const auto memories = noise.weighed();
        fit.memory_s = mean_memory_s(memories);
        MatrixXd scores = MatrixXd::Zero(c.rows(), c.cols());
        for (const NoiseMemory& memory : memories)
            if (memory.weight > 1e-4)
                for (const FitSeries& one : series)
                    if (!one.t.empty()) scores += memory.weight * score_covariance(one, memory);
        fit.outliers = static_cast<int>(places_.size()) - used;
        fit.degrees_of_freedom = directions_ * used - static_cast<int>(free_.size());
        const double alike = 1.0 + 2.0 * fit.memory_s / step;  // samples for each independent one
        const double known_by =
            std::max(fit.degrees_of_freedom / (alike * directions_ * series_), kFewestIndependent);
        const MatrixXd small = known_by / (known_by - 2.0) * c * scores * c;

        fit.from_noise = MatrixXd::Zero(n_, n_);
        fit.by_prior = MatrixXd::Zero(n_, n_);
        for (std::size_t a = 0; a < free_.size(); ++a)
            for (std::size_t b = 0; b < free_.size(); ++b) {
                const auto row = static_cast<Index>(a);
                const auto column = static_cast<Index>(b);
                fit.from_noise(free_[a], free_[b]) = small(row, column);
                if (prior[column] * std::pow(scale_[free_[b]], 2) >
                    2.0 * kNothingKnown * kNothingKnown)
                    fit.by_prior(free_[a], free_[b]) = c(row, column) * std::sqrt(prior[column]);
            }
        double chi2 = 0.0;
        for (std::size_t i = 0; i < places_.size(); ++i)
            if (use_[i]) chi2 += fit.residuals[i].squaredNorm();
        fit.reduced_chi2 = chi2 / std::max(fit.degrees_of_freedom, 1);
        return fit;
    }

    std::span<const ResidualPlace> places_;
    const ResidualModel& model_;
    Index n_;
    std::vector<Index> free_;
    VectorXd at_, scale_, prior_, prior_information_;
    int series_ = 1;
    int directions_ = 3;
    std::vector<Matrix3d> rescale_;
    std::vector<bool> use_;
    double huber_ = 3.0;
};

}  // namespace

Result<ResidualFit> fit_residuals(
    std::span<const ResidualPlace> places,
    const ResidualModel& model,
    std::span<const PathParameter> parameters,
    const ResidualFitSettings& settings
) {
    return Fitter(places, model, parameters).run(settings);
}

VectorXd gradient_of(
    const std::function<double(const VectorXd&)>& formula,
    const VectorXd& parameters,
    const MatrixXd& covariance
) {
    VectorXd gradient = VectorXd::Zero(parameters.size());
    for (Index i = 0; i < gradient.size(); ++i) {
        const double sigma = std::sqrt(std::max(covariance(i, i), 0.0));
        if (sigma == 0.0) continue;
        VectorXd high = parameters;
        VectorXd low = parameters;
        high[i] += 0.1 * sigma;
        low[i] -= 0.1 * sigma;
        gradient[i] = (formula(high) - formula(low)) / (0.2 * sigma);
    }
    return gradient;
}

}  // namespace kinectlab
