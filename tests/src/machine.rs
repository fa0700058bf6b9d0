//! Who has the machine: one test that needs it alone, or several beside each other.
//!
//! A test that starts a program has the machine beside others. One with deadlines of its own, or that measures how busy
//! a process is, asks for it [`alone`]. Either holds it to the end of its thread, which is the test's own. Threads that a
//! test starts have no name, and share what their test holds.

use std::cell::Cell;
use std::sync::{Condvar, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// How a thread has the machine.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Company {
    Beside,
    Alone,
}

/// Those who have the machine, and those who wait to have it alone.
struct Users {
    beside: usize,
    alone: usize,
    waiting: usize,
}

static USERS: (Mutex<Users>, Condvar) =
    (Mutex::new(Users { beside: 0, alone: 0, waiting: 0 }), Condvar::new());

/// What a thread has; given back when the thread ends.
struct Hold(Cell<Option<Company>>);

thread_local! {
    static HOLD: Hold = const { Hold(Cell::new(None)) };
}

impl Hold {
    fn take(&self, company: Company) {
        let (users, changed) = &USERS;
        let mut users = users.lock().unwrap_or_else(PoisonError::into_inner);
        match company {
            Company::Beside => {
                // Who waits to be alone goes first.
                let is_closed = |users: &mut Users| users.alone + users.waiting > 0;
                users = changed.wait_while(users, is_closed).unwrap_or_else(PoisonError::into_inner);
                users.beside += 1;
            }
            Company::Alone => {
                users.waiting += 1;
                let is_used = |users: &mut Users| users.alone + users.beside > 0;
                users = changed.wait_while(users, is_used).unwrap_or_else(PoisonError::into_inner);
                users.waiting -= 1;
                users.alone += 1;
            }
        }
        drop(users);
        self.0.set(Some(company));
    }

    fn give_back(&self) {
        let Some(company) = self.0.take() else { return };
        let (users, changed) = &USERS;
        let mut users = users.lock().unwrap_or_else(PoisonError::into_inner);
        match company {
            Company::Beside => users.beside -= 1,
            Company::Alone => users.alone -= 1,
        }
        drop(users);
        changed.notify_all();
    }
}

impl Drop for Hold {
    fn drop(&mut self) {
        self.give_back();
    }
}

/// Waits until no other test has the machine; none gets it before this one ends. For tests with deadlines.
pub fn alone() {
    HOLD.with(|hold| {
        if hold.0.get() != Some(Company::Alone) {
            hold.give_back();
            hold.take(Company::Alone);
        }
    });
}

/// Waits until no test has the machine alone. Asked by whatever starts a program.
pub(crate) fn beside_others() {
    HOLD.with(|hold| {
        if hold.0.get().is_none() && thread::current().name().is_some() {
            hold.take(Company::Beside);
        }
    });
}

/// Looks until what is wanted is to be seen, and fails if it is not within a while.
#[track_caller]
pub fn wait_for(what: &str, is_there: impl Fn() -> bool) {
    let since = Instant::now();
    while !is_there() {
        assert!(since.elapsed() < Duration::from_secs(60), "there is no sign of {what}");
        thread::sleep(Duration::from_millis(100));
    }
}

/// There is no such window system: said aloud, and a failure with LIGHTLOOM_REQUIRE_WINDOWS=1.
pub fn lacks_windows(what: &str) {
    println!("SKIPPED: {what}");
    let is_required = std::env::var("LIGHTLOOM_REQUIRE_WINDOWS").as_deref() == Ok("1");
    assert!(!is_required, "LIGHTLOOM_REQUIRE_WINDOWS=1, and {what}");
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};
    use std::time::Duration;

    #[test]
    fn who_is_alone_has_no_company() {
        static INSIDE: AtomicUsize = AtomicUsize::new(0);
        let run = |name: String, ask: fn(), most: usize| {
            let work = move || {
                ask();
                let inside = INSIDE.fetch_add(1, SeqCst) + 1;
                thread::sleep(Duration::from_millis(2));
                // A thread of a test starts a program without waiting for it.
                thread::scope(|scope| drop(scope.spawn(beside_others).join()));
                let left = INSIDE.fetch_sub(1, SeqCst);
                assert!(inside.max(left) <= most, "{inside} and {left} at a time");
                inside
            };
            thread::Builder::new().name(name).spawn(work).expect("a thread can be started")
        };
        let threads: Vec<_> = (0..40)
            .map(|i| match i % 4 {
                0 => run(format!("alone {i}"), alone, 1),
                _ => run(format!("beside {i}"), beside_others, 40),
            })
            .collect();
        let most = threads.into_iter().map(|one| one.join().expect("it held its law")).max();
        assert!(most > Some(1), "the canary: others do run beside each other");
    }
}
