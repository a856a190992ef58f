//! The table of records, `pages/records/registry.toml`.

use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// All records, and the groups of sources that they name.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordRegistry {
    groups: BTreeMap<String, Vec<String>>,
    /// The records by name.
    pub records: BTreeMap<String, CampaignRecord>,
}

/// What a campaign leaves, and where its claims stand.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CampaignRecord {
    /// What the campaign writes.
    pub file: String,
    /// The page with its claims.
    pub page: String,
    /// What of the page rests on it.
    pub claim: String,
    /// What makes it again.
    pub command: String,
    /// Files, folders, groups.
    sources: Vec<String>,
}

impl RecordRegistry {
    /// Reads the table of the tree below `root`.
    ///
    /// # Errors
    /// A table that cannot be read, and a record whose file is not there.
    pub fn read(root: &Path) -> Result<RecordRegistry> {
        let path = root.join("pages/records/registry.toml");
        let text = fs::read_to_string(&path).into_diagnostic();
        let text = text.wrap_err_with(|| format!("cannot read {}", path.display()))?;
        let registry: RecordRegistry = toml::from_str(&text)
            .into_diagnostic()
            .wrap_err("pages/records/registry.toml")?;
        for (name, record) in &registry.records {
            if !root.join(&record.file).exists() {
                return Err(miette!("{} of record {name} is not there", record.file));
            }
        }
        Ok(registry)
    }

    /// A record.
    ///
    /// # Errors
    /// A name that the table does not have.
    pub fn record(&self, name: &str) -> Result<&CampaignRecord> {
        let record = self.records.get(name);
        record.ok_or_else(|| miette!("pages/records/registry.toml has no record {name}"))
    }

    /// What a record depends on, with the groups written out.
    ///
    /// # Errors
    /// A group that the table does not have.
    pub fn sources(&self, record: &CampaignRecord) -> Result<Vec<String>> {
        let mut sources = Vec::new();
        for source in &record.sources {
            match source.strip_prefix('@') {
                None => sources.push(source.clone()),
                Some(group) => {
                    let group = self.groups.get(group);
                    let group = group.ok_or_else(|| {
                        miette!("pages/records/registry.toml has no group {source}")
                    })?;
                    sources.extend_from_slice(group);
                }
            }
        }
        Ok(sources)
    }
}
