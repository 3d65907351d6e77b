//! The session: collects what the inputs of a run give, in order, and ends the run.

use super::file_run::FileRun;
use super::messages;
use super::report_file::ReportFile;
use crate::advice::Flags;
use crate::failure::Failure;
use crate::input::display;
use crate::options::CommonOptions;
use crate::output::PendingFile;
use crate::page::PageCounts;
use crate::report::FileReport;
use crate::status::Status;
use crate::terminal;
use std::path::Path;

/// Most failures that are listed on the terminal; the report holds the rest.
const LISTED: usize = 50;

/// The results of the inputs so far.
pub(super) struct Session<'a> {
    pub(super) options: &'a CommonOptions,
    pub(super) flags: &'a Flags,
    pub(super) report: Option<ReportFile>,
    /// Number of inputs of the whole run.
    pub(super) inputs: usize,
    /// Outputs that appear at the end.
    pub(super) pending: Vec<PendingFile>,
    /// The inputs of which something was left out.
    partial: Vec<String>,
    done: usize,
    failed: usize,
    failures: Vec<String>,
    pages: PageCounts,
}

impl<'a> Session<'a> {
    pub(super) fn new(options: &'a CommonOptions, flags: &'a Flags, report: Option<ReportFile>, inputs: usize) -> Self {
        Self {
            options,
            flags,
            report,
            inputs,
            pending: Vec::new(),
            partial: Vec::new(),
            done: 0,
            failed: 0,
            failures: Vec::new(),
            pages: PageCounts::default(),
        }
    }

    /// Returns `true` if no input has been warped yet.
    pub(super) fn is_untried(&self) -> bool {
        self.done == 0
    }

    /// Adds an input that was warped: prints its notes and warnings.
    pub(super) fn done(&mut self, run: FileRun) -> Result<(), Failure> {
        let several = self.inputs > 1;
        for note in &run.notes {
            terminal::note(&if several { format!("{}: {note}", run.report.file) } else { note.clone() });
        }
        if !self.options.quiet {
            run.page.note().iter().for_each(|note| terminal::note(note));
            // The warnings about pages come last.
            let counted = if several { run.page.warnings().len() } else { 0 };
            messages::warn(&run.report, run.report.warnings.len() - counted);
        }
        self.pages.add(&run.page, &run.report.file);
        self.done += 1;
        if run.partial {
            self.partial.push(run.report.file.clone());
        }
        self.pending.extend(run.files);
        self.report.as_mut().map_or(Ok(()), |r| r.add(&run.report))
    }

    /// Adds an input that was not warped. The message is printed at the end.
    pub(super) fn failed(&mut self, input: &Path, failure: &Failure) -> Result<(), Failure> {
        let message = failure.message(self.flags);
        self.failed += 1;
        if self.failures.len() < LISTED {
            self.failures.push(message.clone());
        }
        self.report.as_mut().map_or(Ok(()), |r| r.add(&FileReport::failed(display(input), message)))
    }

    /// Puts the last outputs in place, and prints the summary.
    pub(super) fn finish(mut self) -> Result<Status, Failure> {
        if let Some(report) = self.report.take() {
            self.pending.push(report.finish()?);
        }
        PendingFile::commit_all(std::mem::take(&mut self.pending))?;
        if !self.options.quiet {
            self.pages.warnings(self.inputs).iter().filter(|_| self.inputs > 1).for_each(|w| terminal::warning(w));
        }
        self.summarise();
        Ok(Status::partial_if(!self.partial.is_empty() || self.failed > 0 || self.pages.are_blank()))
    }

    /// Names the inputs of which something was left out, as the exit code tells of them.
    fn tell_partial(&self) {
        const NAMED: usize = 5;
        if self.partial.is_empty() || self.inputs < 2 || self.options.quiet {
            return;
        }
        let names: Vec<&str> = self.partial.iter().take(NAMED).map(String::as_str).collect();
        let more = self.partial.len().saturating_sub(NAMED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let (n, all) = (self.partial.len(), self.inputs);
        terminal::warning(&format!(
            "{n} of {all} inputs were not warped in full, so the exit code is 1: {}{more}; the warnings and --report FILE say what was left",
            names.join(", ")
        ));
    }

    /// Lists the failures and counts them.
    fn summarise(&self) {
        self.tell_partial();
        if self.failed == 0 {
            return;
        }
        self.failures.iter().for_each(|f| terminal::error(f));
        let more = self.failed - self.failures.len();
        if more > 0 {
            let advice = if self.options.report.is_some() { "the report lists" } else { "--report FILE lists" };
            terminal::error(&format!("and {more} more; {advice} them all"));
        }
        let written = match self.done {
            0 => "nothing was written".to_owned(),
            1 => "the result of the other one is written".to_owned(),
            n => format!("the results of the other {n} are written"),
        };
        terminal::error(&format!("{} of {} inputs failed; {written}", self.failed, self.inputs));
    }
}
