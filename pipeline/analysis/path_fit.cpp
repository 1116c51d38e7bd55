#include "pipeline/analysis/path_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "pipeline/analysis/median.hpp"
#include "pipeline/analysis/residual_correlation.hpp"

namespace kinectlab {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Residuals = std::vector<Vector3d>;
using Jacobians = std::vector<Eigen::Matrix<double, 3, Eigen::Dynamic>>;

constexpr int kMostSteps = 60;
constexpr double kMedianChi2 = 2.366;    // of three degrees of freedom
constexpr double kSmallestNoise = 1e-6;  // share of the given variance below which it is rounding
constexpr double kDifference = 1e-4;     // of a parameter's scale

class Fitter {
public:
    Fitter(
        std::span<const PositionSample> samples,
        const PathModel& model,
        std::span<const PathParameter> parameters
    )
        : samples_(samples), model_(model), n_(static_cast<int>(parameters.size())) {
        for (const auto& sample : samples)
            t_.push_back(sample.t);
        at_ = VectorXd(n_);
        scale_ = VectorXd(n_);
        prior_ = VectorXd(n_);
        prior_information_ = VectorXd::Zero(n_);
        for (int i = 0; i < n_; ++i) {
            const PathParameter& p = parameters[static_cast<std::size_t>(i)];
            const bool fixed = p.prior_u == 0.0;
            at_[i] = fixed ? p.prior : p.start;
            scale_[i] = p.scale;
            prior_[i] = p.prior;
            if (p.prior_u > 0.0) prior_information_[i] = 1.0 / (p.prior_u * p.prior_u);
            if (!fixed) free_.push_back(i);
        }
        use_.assign(samples.size(), true);
        huber_ = 3.0;
    }

    [[nodiscard]] Residuals residuals(const VectorXd& at) const {
        Residuals r(samples_.size());
        model_(at, t_, r);
        for (std::size_t i = 0; i < r.size(); ++i)
            r[i] = samples_[i].p_lab - r[i];
        return r;
    }

    [[nodiscard]] std::vector<double> distances(const Residuals& r, const Matrix3d& rescale) const {
        std::vector<double> d(r.size());
        for (std::size_t i = 0; i < r.size(); ++i)
            d[i] = (rescale * samples_[i].whiten * r[i]).norm();
        return d;
    }

    [[nodiscard]] double cost(const VectorXd& at) const {
        const auto d = distances(residuals(at), rescale_);
        double sum = 0.0;
        for (std::size_t i = 0; i < d.size(); ++i) {
            if (!use_[i]) continue;
            sum += d[i] > huber_ ? huber_ * (d[i] - huber_ / 2) : d[i] * d[i] / 2;
        }
        const VectorXd off = prior_ - at;
        sum += 0.5 * off.cwiseAbs2().dot(prior_information_);
        return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
    }

    /// Whitened, over the free parameters.
    [[nodiscard]] Jacobians jacobians(const VectorXd& at) const {
        const auto n = static_cast<Eigen::Index>(free_.size());
        Jacobians j(samples_.size(), Eigen::Matrix<double, 3, Eigen::Dynamic>::Zero(3, n));
        Residuals high(samples_.size());
        Residuals low(samples_.size());
        for (Eigen::Index k = 0; k < n; ++k) {
            const int i = free_[static_cast<std::size_t>(k)];
            VectorXd moved = at;
            const double step = kDifference * scale_[i];
            moved[i] = at[i] + step;
            model_(moved, t_, high);
            moved[i] = at[i] - step;
            model_(moved, t_, low);
            for (std::size_t s = 0; s < samples_.size(); ++s)
                j[s].col(k) = rescale_ * samples_[s].whiten * (high[s] - low[s]) / (2.0 * step);
        }
        return j;
    }

    void minimise() {
        double lambda = 1e-3;
        double here = cost(at_);
        for (int step = 0; step < kMostSteps; ++step) {
            const auto [information, gradient] = normal_equations();
            const VectorXd prior = free(prior_information_);
            MatrixXd damped = information;
            damped.diagonal() += prior;
            const VectorXd pull = gradient + prior.cwiseProduct(free(prior_ - at_));
            bool better = false;
            double predicted = 0.0;
            while (lambda < 1e12) {
                MatrixXd system = damped;
                system.diagonal() *= 1.0 + lambda;
                const VectorXd change = inverse(system) * pull;
                predicted = change.dot(pull);
                VectorXd trial = at_;
                for (std::size_t k = 0; k < free_.size(); ++k)
                    trial[free_[k]] += change[static_cast<Eigen::Index>(k)];
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

    /// By how much the residuals exceed what the samples say of themselves.
    [[nodiscard]] double noise_factor() const {
        const auto d = distances(residuals(at_), Matrix3d::Identity());
        return std::max(median(d) / std::sqrt(kMedianChi2), std::sqrt(kSmallestNoise));
    }

    /// Makes the used residuals white on average; the median sets the size if that is larger.
    [[nodiscard]] Matrix3d whitening(const Residuals& r) const {
        Matrix3d s = Matrix3d::Zero();
        double n = -static_cast<double>(free_.size()) / 3.0;
        for (std::size_t i = 0; i < r.size(); ++i) {
            if (!use_[i]) continue;
            const Vector3d w = samples_[i].whiten * r[i];
            s += w * w.transpose();
            n += 1.0;
        }
        const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(s / n);
        const Vector3d root =
            eigen.eigenvalues().cwiseMax(kSmallestNoise).cwiseSqrt().cwiseInverse();
        const Matrix3d whiten =
            eigen.eigenvectors() * root.asDiagonal() * eigen.eigenvectors().transpose();
        return whiten / std::max(median(distances(r, whiten)) / std::sqrt(kMedianChi2), 1.0);
    }

    Result<PathFit> run(const PathFitSettings& settings) {
        if (3 * samples_.size() <= free_.size() + 3)
            return fail(
                ErrorCode::bad_data,
                "samples",
                "there are " + std::to_string(samples_.size()),
                "measure for longer, or see that the object stays in the picture"
            );
        if (!std::isfinite(cost(at_)))
            return fail(ErrorCode::bad_data, "samples", "no motion starts from the first guess");
        rescale_ = Matrix3d::Identity() / noise_factor();
        minimise();
        rescale_ = Matrix3d::Identity() / noise_factor();
        minimise();
        huber_ = std::numeric_limits<double>::infinity();
        Residuals r = residuals(at_);
        for (int round = 0; round < 4; ++round) {
            rescale_ = round == 0 ? Matrix3d(Matrix3d::Identity() / noise_factor()) : whitening(r);
            std::vector<bool> use(samples_.size(), true);
            if (settings.allow_outliers) {
                const auto d = distances(r, rescale_);
                for (std::size_t i = 0; i < d.size(); ++i)
                    use[i] = d[i] <= settings.outlier_sigma;
            }
            const auto kept = static_cast<std::size_t>(std::count(use.begin(), use.end(), true));
            if (3 * kept <= free_.size() + 3) break;
            const bool settled = round > 1 && use == use_;
            use_ = std::move(use);
            if (settled) break;
            rescale_ = whitening(r);
            minimise();
            r = residuals(at_);
        }
        return summary(r, settings);
    }

private:
    struct Equations {
        MatrixXd information;
        VectorXd gradient;
    };

    [[nodiscard]] VectorXd free(const VectorXd& all) const {
        VectorXd some(static_cast<Eigen::Index>(free_.size()));
        for (std::size_t k = 0; k < free_.size(); ++k)
            some[static_cast<Eigen::Index>(k)] = all[free_[k]];
        return some;
    }

    [[nodiscard]] Equations normal_equations() const {
        const auto n = static_cast<Eigen::Index>(free_.size());
        const auto r = residuals(at_);
        const auto j = jacobians(at_);
        Equations sum{MatrixXd::Zero(n, n), VectorXd::Zero(n)};
        for (std::size_t s = 0; s < samples_.size(); ++s) {
            if (!use_[s]) continue;
            const Vector3d w = rescale_ * samples_[s].whiten * r[s];
            const double d = w.norm();
            const double weight = d > huber_ ? huber_ / d : 1.0;
            sum.information.noalias() += weight * j[s].transpose() * j[s];
            sum.gradient.noalias() += weight * j[s].transpose() * w;
        }
        return sum;
    }

    [[nodiscard]] static MatrixXd inverse(const MatrixXd& m) {
        const VectorXd scale = m.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
        const MatrixXd scaled = scale.asDiagonal() * m * scale.asDiagonal();
        return scale.asDiagonal() * scaled.ldlt().solve(MatrixXd::Identity(m.rows(), m.cols())) *
               scale.asDiagonal();
    }

    [[nodiscard]] MatrixXd spread(const MatrixXd& some) const {
        MatrixXd all = MatrixXd::Zero(n_, n_);
        for (std::size_t a = 0; a < free_.size(); ++a)
            for (std::size_t b = 0; b < free_.size(); ++b)
                all(free_[a], free_[b]) =
                    some(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
        return all;
    }

    [[nodiscard]] PathFit summary(const Residuals& r, const PathFitSettings& settings) const {
        PathFit fit;
        fit.parameters = at_;
        fit.residuals = r;
        fit.used = use_;
        const auto n = static_cast<Eigen::Index>(free_.size());
        MatrixXd information = normal_equations().information;
        const VectorXd prior = free(prior_information_);
        information.diagonal() += prior;
        const MatrixXd c = inverse(information);

        const auto j = jacobians(at_);
        std::vector<WhitenedSample> whitened;
        double chi2 = 0.0;
        for (std::size_t s = 0; s < samples_.size(); ++s) {
            if (!use_[s]) {
                ++fit.outliers;
                continue;
            }
            const Vector3d w = rescale_ * samples_[s].whiten * r[s];
            whitened.push_back({samples_[s].t, w, j[s]});
            fit.sum_of_squares += w.squaredNorm();
            chi2 += (samples_[s].whiten * r[s]).squaredNorm();
        }
        fit.degrees_of_freedom = 3 * static_cast<int>(whitened.size()) - static_cast<int>(n);
        // Few samples tell more together with a model of their noise, many without one: whichever
        // leaves the parameters less sure holds.
        MatrixXd noise = covariance_by_lasting_noise(whitened, c, prior);
        const MatrixXd products = 3.0 * static_cast<double>(whitened.size()) /
                                  fit.degrees_of_freedom *
                                  covariance_by_products(whitened, c, settings.correlation_time_s);
        VectorXd widen = VectorXd::Ones(n);
        for (Eigen::Index i = 0; i < n; ++i)
            if (noise(i, i) > 0.0)
                widen[i] = std::sqrt(std::max(1.0, products(i, i) / noise(i, i)));
        noise = widen.asDiagonal() * noise * widen.asDiagonal();
        fit.from_noise = spread(noise);
        fit.by_prior = spread(c * prior.cwiseSqrt().asDiagonal());
        fit.from_priors = spread(c * prior.asDiagonal() * c);
        fit.reduced_chi2 = chi2 / fit.degrees_of_freedom;
        return fit;
    }

    std::span<const PositionSample> samples_;
    const PathModel& model_;
    int n_;
    std::vector<double> t_;
    std::vector<int> free_;
    VectorXd at_, scale_, prior_, prior_information_;
    Matrix3d rescale_ = Matrix3d::Identity();
    std::vector<bool> use_;
    double huber_;
};

}  // namespace

Result<PathFit> fit_path(
    std::span<const PositionSample> samples,
    const PathModel& model,
    std::span<const PathParameter> parameters,
    const PathFitSettings& settings
) {
    return Fitter(samples, model, parameters).run(settings);
}

VectorXd gradient_of(const std::function<double(const VectorXd&)>& formula, const PathFit& fit) {
    const MatrixXd covariance = fit.covariance();
    VectorXd gradient = VectorXd::Zero(fit.parameters.size());
    for (Eigen::Index i = 0; i < gradient.size(); ++i) {
        const double sigma = std::sqrt(std::max(covariance(i, i), 0.0));
        if (sigma == 0.0) continue;
        VectorXd high = fit.parameters;
        VectorXd low = fit.parameters;
        high[i] += 0.1 * sigma;
        low[i] -= 0.1 * sigma;
        gradient[i] = (formula(high) - formula(low)) / (0.2 * sigma);
    }
    return gradient;
}

}  // namespace kinectlab
