//! What scenes say of winds and water, as the solver takes it, and what they must not say.

use super::*;
use boucle_solver::{Bulk, Flow, Gusts, Turbulence, Water, Wind, WindLaw};

const CLOTH: &str = "[[cloth]]\nname = \"flag\"\ngrid = { size = [1, 1], vertices = [3, 3] }\n";

fn scene(keys: &str) -> crate::Result<Scene> {
    Scene::from_toml(&format!("{CLOTH}{keys}"), &[])
}

fn force(keys: &str) -> Force {
    let scene = scene(&format!("[[force]]\n{keys}")).expect(keys);
    scene.force.into_iter().next().expect("one")
}

fn wind(keys: &str) -> Wind {
    let wind =
        force(&format!("kind = \"wind\"\nvelocity = [0, 8, 0]\n{keys}")).wind("force.0", &[]);
    wind.expect("good keys").expect("a wind")
}

#[test]
fn a_wind_reads_its_coefficients_gusts_turbulence_and_shelter() {
    let plain = wind("air_density = 1.2");
    assert_eq!(plain.law, WindLaw::Face(Flow::new(1.2)));
    assert_eq!((plain.gusts, plain.turbulence, plain.is_sheltered), (None, None, false));
    let whole = wind(
        "air_density = 1.2\ndrag_coefficient = 1.17\nlift_coefficient = 0.8\nfriction_coefficient = 0.02\n\
         gusts = { strength = 0.5, period = 3.0 }\nshelter = true\n\
         turbulence = { intensity = 0.2, size = 1.5, seed = 7 }",
    );
    let flow = Flow { density: 1.2, drag: 1.17, lift: Some(0.8), friction: 0.02 };
    assert_eq!(whole.law, WindLaw::Face(flow));
    assert_eq!(whole.gusts, Some(Gusts { strength: 0.5, period: 3.0, seed: 1 }));
    assert_eq!(whole.turbulence, Some(Turbulence { intensity: 0.2, size: 1.5, seed: 7 }));
    assert!(whole.is_sheltered);
}

#[test]
fn water_reads_its_surface_current_and_waves_and_a_cloth_what_it_is_in_it() {
    let water = |keys: &str| {
        force(&format!("kind = \"water\"\n{keys}")).water("force.0").expect("good").expect("water")
    };
    assert_eq!(water(""), Water::default());
    let whole = water(
        "level = 0.5\ndensity = 1025\nvelocity = [1, 0, 0]\nlift_coefficient = 1\n\
         waves = [{ amplitude = 0.1, length = 3 }, { amplitude = 0.02, length = 1, direction = [0, 1, 0] }]",
    );
    assert!((whole.level, whole.velocity.x, whole.flow.density) == (0.5, 1.0, 1025.0));
    assert_eq!((whole.flow.lift, whole.flow.friction.to_bits()), (Some(1.0), 0.01_f64.to_bits()));
    let ways: Vec<[f64; 3]> = whole.waves.iter().map(|wave| wave.direction.into()).collect();
    assert!(ways == [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(scene("").expect("good").cloth[0].water.bulk(), Bulk::default());
    let cotton = scene(
        "water = { bulk_density = 400, hull = false, absorbency = 2, soak_time = 5, dry_time = 60 }",
    );
    let bulk = Bulk {
        density: 400.0,
        is_hull: Some(false),
        absorbency: 2.0,
        soak_time: 5.0,
        dry_time: Some(60.0),
    };
    assert_eq!(cotton.expect("good").cloth[0].water.bulk(), bulk);
}

#[test]
fn what_winds_and_water_must_not_say_is_refused_by_key_and_value() {
    const WIND: &str = "kind = \"wind\"\nvelocity = [0, 8, 0]\n";
    for (head, keys, said) in [
        (
            WIND,
            "coefficient = 1\nlift_coefficient = 1",
            "force.0: coefficient and lift_coefficient",
        ),
        (WIND, "air_density = 1\ndrag_coefficient = -1", "force.0: air's drag_coefficient is -1"),
        (WIND, "air_density = 1\nlevel = 1", "force.0.level is no key of \"wind\""),
        (WIND, "air_density = 1\ngusts = { strength = 1 }", "force.0.gusts.period is missing"),
        (
            WIND,
            "air_density = 1\ngusts = { strength = 1, period = 0 }",
            "force.0: the period of gusts (s) in a wind is 0",
        ),
        (
            WIND,
            "air_density = 1\nturbulence = { intensity = -1, size = 1 }",
            "force.0: the intensity of turbulence in a wind is -1",
        ),
        (WIND, "air_density = 1\nshelter = 3", "force.0.shelter = 3; accepted: true or false"),
        ("kind = \"water\"\n", "air_density = 1", "force.0.air_density is no key of \"water\""),
        (
            "kind = \"water\"\n",
            "region = { vertices = [1] }",
            "force.0.region is no key of \"water\"",
        ),
        ("kind = \"water\"\n", "level = nan", "force.0: water: level (m) is NaN"),
        (
            "kind = \"water\"\n",
            "waves = [{ amplitude = 1, length = 0 }]",
            "force.0: water: length of a wave (m) is 0",
        ),
        (
            "kind = \"water\"\n",
            "[[force]]\nkind = \"water\"",
            "force.1.kind = \"water\" is the scene's second",
        ),
        (
            "kind = \"drag\"\nstrength = 1\n",
            "shelter = true",
            "force.0.shelter is no key of \"drag\"",
        ),
    ] {
        let refused = scene(&format!("[[force]]\n{head}{keys}")).expect_err(keys).to_string();
        assert!(refused.starts_with(said), "{refused}");
        assert!(refused.contains("accepted: ") || refused.ends_with("is missing"), "{refused}");
    }
    let fields = fields_from_json(r#"[{"kind": "water"}]"#).expect_err("no field").to_string();
    assert!(fields.starts_with("force.0.kind = \"water\" is no field"), "{fields}");
}
