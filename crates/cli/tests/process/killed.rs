//! Runs that are killed at random instants.

use super::{
    ASIDE, Bytes, COMPLETE, EARLIER, NEW, Random, arguments, check_killed, run_and_kill, status,
    twice, whole,
};
use crate::command_line::{expect, files, looselink};
use std::fs;

#[test]
fn a_killed_run_is_readable_and_marked_and_can_be_repeated() {
    let folder = tempfile::tempdir().unwrap();
    let (bytes, time) = whole(&folder.path().join("whole"), NEW);
    let stages = std::sync::Mutex::new([0; 4]);
    twice(|thread| {
        let mut random = Random(thread);
        for n in 0..100 {
            let out = folder.path().join(format!("{thread}-{n}"));
            let ended = run_and_kill(&out, &[NEW], random.moment(time));
            check_killed(&out, &bytes);
            let rows = fs::read(out.join("channels.csv")).unwrap_or_default();
            let rows = rows.iter().filter(|b| **b == b'\n').count();
            let stage = match (ended, rows) {
                (true, _) => 3,
                (_, 2..) => 2,
                (_, 1) => 1,
                _ => 0,
            };
            stages.lock().unwrap()[stage] += 1;
            if ended || n % 4 == 0 {
                expect(&looselink(&arguments(&out, &[NEW, "--force"])), 0, "");
                assert_eq!(files(&out), COMPLETE);
                assert_eq!(Bytes::of(&out).repeatable(), bytes.repeatable());
            }
            let _ = fs::remove_dir_all(&out);
        }
    });
    // before there was anything, with a header, with rows, after the end
    let [nothing, _, rows, ended] = stages.into_inner().unwrap();
    assert!(
        nothing > 0 && rows > 20 && ended > 0,
        "{nothing} {rows} {ended}"
    );
}

/// The earlier result stands in its place or aside, byte for byte, until the new one is complete; also after a second kill.
#[test]
fn a_run_killed_while_it_replaces_a_result_leaves_that_whole() {
    let folder = tempfile::tempdir().unwrap();
    let (new, time) = whole(&folder.path().join("new"), NEW);
    let (earlier, _) = whole(&folder.path().join("earlier"), EARLIER);
    let stages = std::sync::Mutex::new([0; 3]);
    twice(|thread| {
        let mut random = Random(10 + thread);
        for n in 0..50 {
            let out = folder.path().join(format!("{thread}-{n}"));
            earlier.lay(&out);
            let mut held = Bytes::of(&out);
            for _ in 0..2 {
                run_and_kill(&out, &[NEW, "--force"], random.moment(time));
                let found = Bytes::of(&out);
                let (in_place, aside) = (found == held, Bytes::of(&out.join(ASIDE)) == held);
                let replaced = found.repeatable() == new.repeatable();
                assert!(in_place || aside || replaced, "{:?}", files(&out));
                // between the two results what is left of the earlier one has no summary
                let mut files = found.0.iter().zip(&held.0);
                let left = files.all(|(found, held)| found.is_empty() || found == held);
                if !in_place && (status(&out).is_some() || !left) {
                    check_killed(&out, &new);
                }
                let stage = if in_place {
                    0
                } else {
                    1 + usize::from(replaced)
                };
                stages.lock().unwrap()[stage] += 1;
                if replaced {
                    held = found;
                }
            }
            if n % 5 == 0 {
                expect(&looselink(&arguments(&out, &[NEW, "--force"])), 0, "");
                assert_eq!(files(&out), COMPLETE);
                assert_eq!(Bytes::of(&out).repeatable(), new.repeatable());
            }
            fs::remove_dir_all(&out).unwrap();
        }
    });
    let [in_place, aside, replaced] = stages.into_inner().unwrap();
    assert!(
        in_place > 0 && aside > 10 && replaced > 0,
        "{in_place} {aside} {replaced}"
    );
}
