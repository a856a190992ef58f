//! The largest of many errors.

use std::cell::{Cell, RefCell};

/// Keeps the largest error it sees, and where. An error that is not a number stays the largest.
#[derive(Debug, Default)]
pub struct Worst {
    largest: Cell<Option<f64>>,
    here: RefCell<String>,
    place: RefCell<String>,
}

/// An error, and where it was seen; the place is empty when it is not known.
pub trait MeasuredError {
    /// Both.
    fn error(&self) -> (f64, String);
}

impl MeasuredError for f64 {
    fn error(&self) -> (f64, String) {
        (*self, String::new())
    }
}

impl MeasuredError for &Worst {
    fn error(&self) -> (f64, String) {
        (self.value(), self.place.borrow().clone())
    }
}

impl Worst {
    /// Nothing seen yet.
    pub fn new() -> Worst {
        Worst::default()
    }

    /// Names what is looked at from here on: a scene, a channel.
    pub fn at(&self, place: impl Into<String>) {
        *self.here.borrow_mut() = place.into();
    }

    /// Looks at an error, of either sign.
    pub fn see(&self, error: f64) {
        let (error, largest) = (error.abs(), self.largest.get());
        if largest.is_none_or(|largest| error > largest || error.is_nan() && !largest.is_nan()) {
            self.largest.set(Some(error));
            self.place.borrow_mut().clone_from(&self.here.borrow());
        }
    }

    /// The largest error.
    ///
    /// # Panics
    /// When nothing was seen: a check of nothing proves nothing.
    pub fn value(&self) -> f64 {
        self.largest.get().expect("an error was looked at")
    }
}

#[cfg(test)]
mod tests {
    use super::{MeasuredError, Worst};

    #[test]
    fn what_is_not_a_number_is_worst() {
        let worst = Worst::new();
        worst.see(-2.0);
        worst.see(1.0);
        assert_eq!(worst.value(), 2.0);
        worst.see(f64::NAN);
        worst.see(3.0);
        assert!(worst.value().is_nan());
    }

    #[test]
    fn the_place_is_that_of_the_largest() {
        let worst = Worst::new();
        for (place, error) in [("a", 1.0), ("b", -3.0), ("c", 2.0)] {
            worst.at(place);
            worst.see(error);
        }
        assert_eq!((&worst).error(), (3.0, "b".to_owned()));
    }

    #[test]
    #[should_panic(expected = "an error was looked at")]
    fn nothing_has_no_worst() {
        Worst::new().value();
    }
}
