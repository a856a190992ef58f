//! The last lines of a run: what it came to, and how its steps were chosen.

use looselink::simulate::{AccuracyReport, Choice, Report};
use messages::closing_table;
use numbers::number;

/// Lines about a finished run, most of them absent when there is nothing to say; warnings are not among them.
pub fn lines(report: &Report) -> Vec<String> {
    let mut lines = closing_table(report);
    lines.extend(report.choice.iter().map(choice));
    lines.extend(report.accuracy.iter().map(accuracy));
    let impacts = report.ended_contacts > 0;
    let holds = |control| holds(control, impacts);
    lines.extend(report.accuracy.iter().map(holds));
    lines
}

/// Which scheme was chosen, how much work the trial runs predict, and how far they came.
fn choice(choice: &Choice) -> String {
    let predicted = choice.trial_runs.iter().map(|run| match run.error {
        None => format!(
            "{} {:.1e} (trial run to {} s)",
            run.method,
            run.predicted_operations,
            number(run.t, 2)
        ),
        Some(_) => format!("{} failed", run.method),
    });
    format!(
        "method: {}, chosen by trial runs; operations predicted for the whole run: {}",
        choice.method,
        predicted.collect::<Vec<_>>().join(", ")
    )
}

/// What the steps were that an accuracy asked for.
fn accuracy(control: &AccuracyReport) -> String {
    let [shortest, longest] = control.steps;
    let mut line = format!("accuracy: {} requested", control.asked);
    if control.followed < control.asked.position {
        line += &format!(
            ", {} m used (limited by the clearance)",
            number(control.followed, 2)
        );
    }
    line += &format!(
        ", steps from {} s to {} s",
        number(shortest, 2),
        number(longest, 2)
    );
    let most = control.rejected_by.iter().max_by_key(|(_, count)| **count);
    if let Some((name, count)) = most {
        line += &format!(
            "; steps rejected for their estimated error: {} ({count} of them for {name})",
            control.rejected_steps
        );
    }
    line
}

/// For which motions the accuracy holds, and what tells whether the motion of the run is one of them. A tenth of the accuracy asked
/// for might be above the limit that the clearance sets, and give the same run.
fn holds(control: &AccuracyReport, impacts: bool) -> String {
    let finer = number(0.1 * control.followed, 2);
    let how = match impacts {
        true => format!("; impacts do: compare with a run at position={finer}"),
        false => format!("; a run at position={finer} shows whether this one does"),
    };
    format!("the accuracy holds for {}{how}", control.holds_for)
}
