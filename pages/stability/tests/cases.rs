//! The criteria of the fifteen hard cases, but for those of long runs.

use stability::cases::CASES;

/// Makes the checks of a case and asserts them, all reported if one fails.
fn holds(number: usize) {
    let case = CASES[number - 1];
    assert_eq!(case.number, number);
    let checks = (case.checks)();
    assert!(!checks.is_empty());
    let failed: Vec<String> = checks
        .iter()
        .filter(|check| !check.holds())
        .map(|check| {
            format!(
                "{}: {}, not {}",
                check.criterion,
                check.number(),
                check.bound()
            )
        })
        .collect();
    assert!(failed.is_empty(), "{}: {failed:#?}", case.title);
}

macro_rules! cases {
    ($($name:ident = $number:literal;)*) => {
        $(#[test]
        fn $name() {
            holds($number);
        })*

        #[test]
        fn every_case_is_tested() {
            assert_eq!([$($number),*], CASES.map(|case| case.number));
        }
    };
}

cases! {
    stiff_springs_and_trusses = 1;
    spring_of_any_stiffness = 2;
    link_spinning_free = 3;
    clearance_to_nothing = 4;
    restitution_and_contact_stiffness = 5;
    rigid_limit = 6;
    platform_of_any_mass = 7;
    grazing_resting_chattering = 8;
    stick_and_slip = 9;
    singular_poses = 10;
    fifty_thousand_rpm = 11;
    many_elements_and_slender_ones = 12;
    steps_far_too_long = 13;
    redundant_constraints = 14;
    many_steps = 15;
}
