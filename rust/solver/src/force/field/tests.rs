use super::*;

const EPS: f64 = 1e-12;

/// A field at (1, 0, 0) with its axis along y.
fn field(kind: FieldKind, strength: f64) -> Field {
    Field { location: Vector::x(), axis: 2.0 * Vector::y(), ..Field::new(kind, strength) }
}

fn push_at(field: &Field, x: [f64; 3], v: [f64; 3]) -> Push {
    let mut push = Push::default();
    field.push(&x.into(), &v.into(), 0.0, 0.0, &mut push);
    push
}

/// The pressure (N/m²) in its own direction, and how a turn adds to it.
#[track_caller]
fn assert_pressure(field: &Field, x: [f64; 3], v: [f64; 3], expected: [f64; 3]) {
    field.check().expect("a field");
    let push = push_at(field, x, v);
    let pressure = push.free + Vector::from(v).cross(&push.turn);
    let error = (pressure - Vector::from(expected)).norm();
    assert!(error < EPS, "{field:?}: {pressure:?} is not {expected:?}");
}

const STILL: [f64; 3] = [0.0; 3];

#[test]
fn a_point_field_pushes_away_and_by_the_inverse_square_of_the_distance_if_asked() {
    let point = |inverse_square| field(FieldKind::Point { inverse_square }, 6.0);
    assert_pressure(&point(false), [1.0, 0.0, 2.0], STILL, [0.0, 0.0, 6.0]);
    assert_pressure(&point(true), [1.0, 0.0, 2.0], STILL, [0.0, 0.0, 1.5]);
    // At the very place nothing can be said of the direction.
    assert_pressure(&point(true), [1.0, 0.0, 0.0], STILL, STILL);
    let line = Field { shape: FieldShape::Line, ..point(false) };
    assert_pressure(&line, [3.0, 5.0, 0.0], STILL, [6.0, 0.0, 0.0]);
    let plane = Field { shape: FieldShape::Plane, ..point(false) };
    assert_pressure(&plane, [3.0, -5.0, 0.0], STILL, [0.0, -6.0, 0.0]);
}

#[test]
fn a_wind_field_blows_along_its_axis_less_by_what_flows_with_it() {
    let wind = Field { flow: 0.5, pressure: 0.1, ..field(FieldKind::Wind, 6.0) };
    assert_pressure(&wind, [9.0, 9.0, 9.0], STILL, [0.0, 0.6, 0.0]);
    assert_pressure(&wind, [9.0, 9.0, 9.0], [1.0, 2.0, 0.0], [-0.05, 0.5, 0.0]);
    let push = push_at(&Field { wind_factor: 0.25, ..wind }, [9.0; 3], STILL);
    assert!((push.free - 0.45 * Vector::y()).norm() < EPS);
    assert!((push.normal - 0.15 * Vector::y()).norm() < EPS);
    assert!((push.damping - 0.05).abs() < EPS);
}

#[test]
fn a_vortex_whirls_around_its_axis() {
    let vortex = field(FieldKind::Vortex, 3.0);
    // y x z = x; as fast as it is far.
    assert_pressure(&vortex, [1.0, 0.0, 2.0], STILL, [6.0, 0.0, 0.0]);
    // From a plane: 3 y x 2 z = 6 x, 3 y x 6 x = -18 z, less the velocity.
    let plane = Field { shape: FieldShape::Plane, ..vortex };
    assert_pressure(&plane, [1.0, 7.0, 2.0], [0.5, 0.0, 1.0], [5.5, 0.0, -19.0]);
}

#[test]
fn drag_is_the_sum_of_two_powers_of_the_speed() {
    let drag = Field { damping: 0.5, ..field(FieldKind::Drag, 2.0) };
    // At 5 m/s: (2 · 5 + 0.5) of the velocity.
    assert_pressure(&drag, [4.0; 3], [3.0, 0.0, -4.0], [-31.5, 0.0, 42.0]);
    assert!((push_at(&drag, [4.0; 3], [3.0, 0.0, -4.0]).damping - 20.5).abs() < EPS);
}

#[test]
fn a_harmonic_field_holds_at_its_rest_length_and_damps() {
    let harmonic = Field { damping: 0.5, ..field(FieldKind::Harmonic { rest_length: 0.5 }, 4.0) };
    // 4 (2 - 0.5) back, and 2 · 0.5 · √4 of the velocity.
    assert_pressure(&harmonic, [1.0, 0.0, 2.0], [1.0, 0.0, 0.0], [-2.0, 0.0, -6.0]);
    let push = push_at(&harmonic, [1.0, 0.0, 2.0], STILL);
    assert!((push.damping - 2.0).abs() < EPS && (push.stiffness - 4.0).abs() < EPS);
}

#[test]
fn a_magnetic_field_pushes_across_the_velocity_and_does_no_work() {
    let magnetic = field(FieldKind::Magnetic, 3.0);
    // y x z = x around the axis; z x x = y.
    assert_pressure(&magnetic, [1.0, 0.0, 2.0], [0.0, 0.0, 1.0], [0.0, 3.0, 0.0]);
    let plane = Field { shape: FieldShape::Plane, ..magnetic };
    assert_pressure(&plane, [1.0, 0.0, 2.0], [0.0, 0.0, 1.0], [-3.0, 0.0, 0.0]);
}

#[test]
fn falloff_fades_as_blenders_does() {
    let range = |power, min, max| Range { power, min, max };
    let wind =
        |falloff| Field { falloff, location: Vector::zeros(), ..field(FieldKind::Wind, 1.0) };
    let sphere = Falloff { distance: range(2.0, Some(0.5), Some(3.0)), ..Falloff::default() };
    for (distance, expected) in
        [(0.4, 1.0), (0.5, 1.0), (1.5, 0.25), (2.9, 3.4_f64.powi(-2)), (3.1, 0.0)]
    {
        assert_pressure(&wind(sphere), [distance, 0.0, 0.0], STILL, [0.0, expected, 0.0]);
    }
    let radial = range(1.0, None, Some(45.0));
    let tube = Falloff { shape: FalloffShape::Tube, radial, ..sphere };
    assert_pressure(&wind(tube), [3.0, -1.5, 0.0], STILL, [0.0, 0.25 / 4.0, 0.0]);
    let cone = Falloff { shape: FalloffShape::Cone, ..tube };
    // 30 degrees from the axis, 1.5 m along it.
    let across = 1.5 * 30_f64.to_radians().tan();
    assert_pressure(&wind(cone), [across, 1.5, 0.0], STILL, [0.0, 0.25 / 31.0, 0.0]);
    assert_pressure(&wind(cone), [1.6, 1.5, 0.0], STILL, STILL);
    for (side, in_front, behind) in [(Side::Positive, 1.0, 0.0), (Side::Negative, 0.0, 1.0)] {
        let falloff = Falloff { side, ..Falloff::default() };
        assert_pressure(&wind(falloff), [5.0, 1.0, 0.0], STILL, [0.0, in_front, 0.0]);
        assert_pressure(&wind(falloff), [5.0, -1.0, 0.0], STILL, [0.0, behind, 0.0]);
    }
}

/// Slopes by central differences against what stands in the matrix: never less. A whirl is no
/// slope of that kind, nor is a turn.
#[test]
fn damping_and_stiffness_are_no_less_than_the_slopes_of_the_force() {
    let kinds = [
        FieldKind::Wind,
        FieldKind::Drag,
        FieldKind::Harmonic { rest_length: 0.0 },
        FieldKind::Harmonic { rest_length: 0.7 },
        FieldKind::Vortex,
    ];
    for kind in kinds {
        for shape in [FieldShape::Point, FieldShape::Plane] {
            let field = Field { shape, flow: 0.3, damping: 0.4, ..field(kind, 1.5) };
            let (x, v) = ([1.3, 0.4, -0.6], [0.5, -1.0, 0.2]);
            let known = push_at(&field, x, v);
            for axis in 0..3 {
                let slope =
                    |of: &dyn Fn(f64) -> Push| (of(1e-5).free - of(-1e-5).free)[axis] / 2e-5;
                let shifted = |at: [f64; 3], shift: f64| {
                    std::array::from_fn(|i| if i == axis { at[i] + shift } else { at[i] })
                };
                let damping = -slope(&|shift| push_at(&field, x, shifted(v, shift)));
                assert!(damping <= known.damping + 1e-8, "{field:?}: {damping}");
                let stiffness = -slope(&|shift| push_at(&field, shifted(x, shift), v));
                let whirls = kind == FieldKind::Vortex;
                assert!(whirls || stiffness <= known.stiffness + 1e-8, "{field:?}: {stiffness}");
            }
        }
    }
}

#[test]
fn values_out_of_their_domains_are_refused_by_name() {
    let bad = [
        (Field { strength: f64::NAN, ..field(FieldKind::Wind, 1.0) }, "strength"),
        (Field { weight: -1.0, ..field(FieldKind::Wind, 1.0) }, "weight"),
        (Field { wind_factor: 1.5, ..field(FieldKind::Wind, 1.0) }, "wind_factor"),
        (Field { axis: Vector::zeros(), ..field(FieldKind::Wind, 1.0) }, "axis"),
        (Field { location: Vector::x() * 1e7, ..field(FieldKind::Wind, 1.0) }, "location"),
        (field(FieldKind::Turbulence { size: -1.0, is_global: true }, 1.0), "size"),
        (field(FieldKind::Harmonic { rest_length: f64::INFINITY }, 1.0), "rest_length"),
    ];
    for (field, name) in bad {
        let message = field.check().expect_err(name).to_string();
        assert!(message.starts_with("force field: ") && message.contains(name), "{message}");
    }
}
