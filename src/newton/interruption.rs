//! Who waits for a long computation may stop waiting. What computes has one thread, so this is asked for by thread: no model and no
//! method needs to know of it.

use std::cell::RefCell;
use std::rc::Rc;

type Asked = Rc<dyn Fn() -> bool>;

thread_local! {
    static ASKED: RefCell<Option<Asked>> = const { RefCell::new(None) };
}

/// What was asked before, and is asked again afterwards.
struct Before(Option<Asked>);

impl Drop for Before {
    fn drop(&mut self) {
        ASKED.replace(self.0.take());
    }
}

/// Does `work`, before each of whose iterations of Newton's method outside of the step loop `asked` says whether nobody waits any longer: then the iteration
/// ends as if its state were not finite, at which every method stops. What `work` returns then is worthless.
///
/// `asked` must be fast, and go on saying so once it has.
pub fn interruptible<T>(asked: impl Fn() -> bool + 'static, work: impl FnOnce() -> T) -> T {
    let _before = Before(ASKED.replace(Some(Rc::new(asked))));
    work()
}

/// True where nobody waits any longer.
#[inline]
pub(super) fn has_come() -> bool {
    // what is asked may compute something else meanwhile
    let asked = ASKED.with_borrow(Clone::clone);
    asked.is_some_and(|asked| asked())
}
