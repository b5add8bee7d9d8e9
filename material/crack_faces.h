/// A crack plane that opens, slips and closes: tractions, what opening releases, and the law of a separated particle.
///
/// T is double, or a core::Pack with one particle per lane. The formulas are those of material/separation.h.
#pragma once

#include "core/simd.h"
#include "core/tensor.h"
#include "material/onset.h"
#include "material/rotation.h"
#include "material/separation.h"

namespace material
{
/// Traction on the crack plane, split.
template <class T>
struct Traction
{
    T normal;                // MPa
    core::Vec<T> tangential; // MPa
    T shear() const { return core::sqrt(core::dot(tangential, tangential)); }
};

template <class T>
constexpr Traction<T> traction_on(const core::Sym<T>& stress, const core::Vec<T>& normal)
{
    const core::Vec<T> whole = stress * normal;
    const T along = core::dot(whole, normal);
    return {along, whole - along * normal};
}

/// A particle's crack faces and stress while a step goes on.
template <class T>
struct Faces
{
    core::Vec<T> normal; // 1, unit
    core::Vec<T> slip;   // mm
    T opening;           // mm
    T effective_length;  // mm
    core::Sym<T> stress; // MPa
    T eq_plastic_strain; // 1
    T decohesion_work;   // mJ/mm^3, of the step
    T plastic_work;      // mJ/mm^3, of the step
    T crossed;           // 1 once a second crack has crossed this one, else 0
};

/// Stress after the traction gave way by `released`: sigma^tr - [lambda_L du_n I + mu (n du + du n)] / L_e with
/// du_n = L_e released_n / M, du_t = L_e released_t / mu.
template <class T>
constexpr core::Sym<T> relaxed(const SeparationLaw& law, const core::Sym<T>& trial, const core::Vec<T>& n,
                               const Traction<T>& released)
{
    const T opening = released.normal * T(1 / law.wave_modulus);
    const T volumetric = T(law.lame.lame) * opening;
    // stress part n a^T + a n^T
    const core::Vec<T> a = (T(law.shear_modulus) * opening) * n + released.tangential;
    const T two = T(2.0);
    return {{trial[0] - volumetric - two * n[0] * a[0], trial[1] - volumetric - two * n[1] * a[1],
             trial[2] - volumetric - two * n[2] * a[2], trial[3] - n[0] * a[1] - n[1] * a[0],
             trial[4] - n[1] * a[2] - n[2] * a[1], trial[5] - n[2] * a[0] - n[0] * a[2]}};
}

/// Add the opening that released the traction to the crack and its trapezoidal work to the step, all at once.
template <class T>
constexpr void open(const SeparationLaw& law, const Traction<T>& before, const Traction<T>& trial,
                    const Traction<T>& released, Faces<T>& faces)
{
    const T strain_n = released.normal * T(1 / law.wave_modulus); // du_n / L_e
    const T per_shear = T(1 / law.shear_modulus);
    faces.opening += faces.effective_length * strain_n;
    for (int i = 0; i < 3; ++i) faces.slip[i] += faces.effective_length * released.tangential[i] * per_shear;

    const Traction<T> after{trial.normal - released.normal, trial.tangential - released.tangential};
    const T work = T(0.5) * ((before.normal + after.normal) * strain_n +
                             core::dot(before.tangential + after.tangential, released.tangential) * per_shear);
    // Negative: only the trapezoid's error where a traction changes sign.
    faces.decohesion_work += core::max(work, T(0.0));
    faces.stress = relaxed(law, faces.stress, faces.normal, released);
}

/// Traction a separated crack cannot carry: all tension; all shear beyond friction. Closing stops at zero opening, so
/// the release is negative (the gap gives way to compression) at most by the opening there is.
template <class T>
constexpr Traction<T> unsupported(const SeparationLaw& law, const Faces<T>& faces, const Traction<T>& trial)
{
    const T gap = T(law.wave_modulus) * faces.opening / faces.effective_length; // MPa that closing takes up
    const T released_n = core::max(-gap, trial.normal);
    const T shear = trial.shear();
    const T held = core::min(shear, T(law.friction) * core::max(released_n - trial.normal, T(0.0)));
    return {released_n, core::select(shear > T(0.0), T(1.0) - held / shear, T(0.0)) * trial.tangential};
}

/// Openings up to this share of L_e are closed: the step that closes a crack leaves rounding.
inline constexpr double closed_opening = 1e-9;

template <class T>
constexpr auto is_closed(const Faces<T>& faces)
{
    return faces.opening <= T(closed_opening) * faces.effective_length;
}

/// A second crack (docs/decisions/022). Where the first one stands open the stress that is left lies in its plane, with
/// the principal values a >= b = I1/2 +- sqrt(sigma:sigma/2 - I1^2/4) beside zero. When they pull more than they push
/// and reach a strength, a > s_max or (a - min(b, 0))/2 > tau(L), the metal breaks there too, and from then on it
/// carries stress only while the first crack is closed. What is stored when it breaks, or opens again, is dissipated.
/// @param was_closed  the first crack was at the beginning of the step
template <class T, class Mask>
constexpr void break_across(const SeparationLaw& law, Mask was_closed, Faces<T>& faces)
{
    const T zero(0.0), half(0.5), squared = core::contract(faces.stress, faces.stress);
    const T middle = half * core::trace(faces.stress);
    const T radius = core::sqrt(core::max(half * squared - middle * middle, zero));
    const T high = middle + radius, other = middle - radius, low = core::min(other, zero);
    const T shear_limit =
        shear_strength(lode_parameter(high, core::max(other, zero), low), law.second_shear, law.axial_rise);
    const auto open = !is_closed(faces);
    const auto fails = (high > T(law.second_tension)) | ((middle > zero) & (half * (high - low) > shear_limit));
    const auto breaks = open & (faces.crossed <= zero) & fails;
    const T stored = stored_energy(T(law.lame.lame), T(law.shear_modulus), faces.stress);
    faces.crossed = core::select(breaks, T(1.0), faces.crossed);
    const auto lets_go = open & (faces.crossed > zero);
    faces.decohesion_work += core::select(lets_go & (breaks | was_closed), stored, zero);
    for (T& component : faces.stress.s) component = core::select(lets_go, zero, component);
}

/// Full separation: relax the crack, return what is left to the yield surface, relax what the return put on the crack.
/// The crack goes first, so that free opening is never taken for plastic strain.
/// @param before  traction at the beginning of the step
template <class T>
constexpr void slide(const SeparationLaw& law, Traction<T> before, Faces<T>& faces)
{
    // Without cohesion only friction dissipates: the trapezoid of an opening and closing normal traction is left out.
    const auto relax = [&](auto where) {
        const Traction<T> trial = traction_on(faces.stress, faces.normal);
        Traction<T> released = unsupported(law, faces, trial);
        released.normal = core::select(where, released.normal, T(0.0));
        for (int i = 0; i < 3; ++i) released.tangential[i] = core::select(where, released.tangential[i], T(0.0));
        before.normal = released.normal - trial.normal; // makes the normal part of the trapezoid exactly zero
        open(law, before, trial, released, faces);
        before = {trial.normal - released.normal, trial.tangential - released.tangential};
    };
    const auto was_closed = is_closed(faces);
    relax(faces.effective_length > T(0.0)); // everywhere
    if (law.plastic) {
        const PlasticConstants<T> plastic{T(law.plastic->yield), T(law.plastic->hardening), T(law.plastic->shear_three),
                                          T(law.plastic->per_overstress)};
        const PlasticStep<T> returned = radial_return(faces.stress, faces.eq_plastic_strain, plastic);
        faces.stress = returned.stress;
        faces.eq_plastic_strain = returned.eq_plastic_strain;
        faces.plastic_work = returned.work;
        relax(returned.work > T(0.0));
    }
    if (law.second_crack) break_across(law, was_closed, faces);
}

/// Turn the faces and the stress with the crack plane and add the elastic trial; the traction before is returned.
/// @param spin  1, of the material over the step
template <class T>
constexpr Traction<T> begin_step(const SeparationLaw& law, const core::Vec<T>& spin, const core::Sym<T>& strain,
                                 Faces<T>& faces)
{
    const core::Mat<T> rotation = incremental_rotation(plane_spin(spin, strain, faces.normal));
    const core::Vec<T> turned = rotation * faces.normal;
    faces.normal = (T(1.0) / core::sqrt(core::dot(turned, turned))) * turned;
    faces.slip = rotation * faces.slip;
    const core::Sym<T> old = core::rotated(rotation, faces.stress);
    faces.stress = elastic_trial(old, strain, LameConstants<T>{T(law.lame.lame), T(law.lame.shear_two)});
    faces.decohesion_work = faces.plastic_work = T(0.0);
    return traction_on(old, faces.normal);
}
} // namespace material
